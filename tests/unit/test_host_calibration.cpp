/* Calibrations: what each format gives, and with which words it is refused. SPDX-License-Identifier: Apache-2.0 */
#include <cmath>

#include <gtest/gtest.h>

#include "test_host_folder.h"
#include "tsr/host/calibration.h"
#include "tsr/host/rectification.h"
#include "tsr/host/rectify_table.h"

namespace tsr
{
namespace
{

using test::Folder;

std::string opencv_matrix(const std::string &name, int rows, int cols, const std::string &data)
{
    return name + ": !!opencv-matrix\n   rows: " + std::to_string(rows) + "\n   cols: " + std::to_string(cols) +
           "\n   dt: d\n   data: [ " + data + " ]\n";
}

const std::string kIntrinsics = "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\n" +
                                opencv_matrix("M1", 3, 3, "500., 0., 322.5, 0., 502., 238., 0., 0., 1.") +
                                opencv_matrix("D1", 1, 5, "-3.6e-01, 1.5e-01, 1e-3,\n       -2e-3, 0.") +
                                opencv_matrix("M2", 3, 3, "501., 0., 318., 0., 503., 241., 0., 0., 1.") +
                                opencv_matrix("D2", 1, 5, "-0.35, 0.14, 0, 0, 0");
const std::string kPose =
    opencv_matrix("R", 3, 3, "1., 0., 0., 0., 1., 0., 0., 0., 1.") + opencv_matrix("T", 3, 1, "-60., 0.5, 0.");
const std::string kExtrinsics = "%YAML:1.0\n---\n" + kPose;

std::string ros(const std::string &model, const std::string &d, const std::string &p)
{
    return "image_width: 320\nimage_height: 240\ncamera_name: narrow\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
           "  data: [250, 0, 158, 0, 251, 121, 0, 0, 1]\ndistortion_model: " +
           model +
           "\ndistortion_coefficients:\n  rows: 1\n  cols: " + std::to_string(1 + std::count(d.begin(), d.end(), ',')) +
           "\n  data: [" + d +
           "]\nrectification_matrix:\n  rows: 3\n  cols: 3\n  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n"
           "projection_matrix:\n  rows: 3\n  cols: 4\n  data: [" +
           p + "]\n";
}

const std::string kLeftP = "240, 0, 160, 0, 0, 240, 120, 0, 0, 0, 1, 0";
const std::string kRightP = "240, 0, 164.5, -14.4, 0, 240, 120, 0, 0, 0, 1, 0";

const std::string kMiddlebury = "cam0=[400 0 160.25; 0 400 120; 0 0 1]\ncam1=[400 0 170.5; 0 400 120; 0 0 1]\n"
                                "doffs=10.25\nbaseline=193.001\nwidth=320\nheight=240\nndisp=64\n";

std::string replaced(std::string text, const std::string &what, const std::string &with)
{
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), with);
}

class Calibration : public testing::Test
{
  protected:
    StereoCalibration read(const std::string &text, const CalibrationUnits &units = {})
    {
        return read_calibration({folder_.put("rig.yml", text)}, units);
    }
    StereoCalibration read_two(const std::string &left, const std::string &right)
    {
        return read_calibration({folder_.put("left.yaml", left), folder_.put("right.yaml", right)});
    }
    Folder folder_;
};

TEST_F(Calibration, OpencvInOneFileAndInTwo)
{
    for (const StereoCalibration &found : {read(kIntrinsics + kPose), read_two(kIntrinsics, kExtrinsics)}) {
        EXPECT_EQ(found.format, "OpenCV");
        EXPECT_EQ(found.left.size, (ImageSize{640, 480}));
        EXPECT_DOUBLE_EQ(found.left.fy, 502);
        EXPECT_DOUBLE_EQ(found.right.cx, 318);
        EXPECT_DOUBLE_EQ(found.left.distortion[0], -0.36);
        EXPECT_DOUBLE_EQ(found.left.distortion[3], -2e-3);
        ASSERT_TRUE(found.pose);
        EXPECT_DOUBLE_EQ(found.pose->translation_mm[0], -60);
    }
}

TEST_F(Calibration, OpencvUnitsAndSizes)
{
    EXPECT_DOUBLE_EQ(read(kIntrinsics + kPose, {{}, 10}).pose->translation_mm[1], 5);
    const std::string no_size = replaced(kIntrinsics, "image_width: 640\nimage_height: 480\n", "") + kPose;
    EXPECT_REFUSED(read(no_size), "--calibrated");
    EXPECT_EQ(read(no_size, {{800, 600}, 0}).left.size, (ImageSize{800, 600}));
    EXPECT_EQ(read(replaced(kIntrinsics, "image_width: 640\nimage_height: 480\n", "imageSize: [ 700, 500 ]\n") + kPose)
                  .left.size,
              (ImageSize{700, 500}));
}

TEST_F(Calibration, Ros)
{
    const StereoCalibration found = read_two(ros("plumb_bob", "0.1, -0.2, 0.001, 0, 0", kLeftP),
                                             ros("rational_polynomial", "1, 2, 0, 0, 3, 4, 5, 6", kRightP));
    ASSERT_TRUE(found.views);
    EXPECT_NEAR(found.views->baseline_mm, 60, 1e-9);
    EXPECT_DOUBLE_EQ(found.views->cx_right, 164.5);
    EXPECT_DOUBLE_EQ(found.right.distortion[7], 6);
    const Rectification rectification = rectify_calibration(found, {});
    EXPECT_DOUBLE_EQ(rectification.d0_px(), 4.5);
    EXPECT_DOUBLE_EQ(rectification.views.focal_px, 240);
    const StereoCalibration fisheye =
        read_two(ros("equidistant", "0.1, 0, 0, 0", kLeftP), ros("equidistant", "0, 0, 0, 0", kRightP));
    EXPECT_EQ(fisheye.left.lens, LensModel::equidistant);
}

TEST_F(Calibration, MiddleburyIsScaledAndCut)
{
    const StereoCalibration found = read(kMiddlebury);
    EXPECT_EQ(found.format, "Middlebury");
    RectifyOptions options;
    options.output = {160, 120};
    const Rectification half = rectify_calibration(found, options);
    EXPECT_DOUBLE_EQ(half.views.focal_px, 200);
    EXPECT_DOUBLE_EQ(half.views.cx_left, (160.25 + 0.5) / 2 - 0.5);
    EXPECT_DOUBLE_EQ(half.d0_px(), 5.125); /* a multiple of 1/16 already */
    EXPECT_NEAR(half.source_position(false, {40, 30}).x, 40, 1e-9);
    options.output = {120, 120};
    const Rectification cut = rectify_calibration(found, options);
    EXPECT_DOUBLE_EQ(cut.views.cx_left, half.views.cx_left - 20);
    const RectifyTable table = make_rectify_table(cut, 0, "calib.txt");
    EXPECT_NEAR(table.error_px[0], 0, 1e-9);
    EXPECT_EQ(table.rows_above[0], 0);
}

TEST_F(Calibration, BoofCvGivesTheInverse)
{
    const std::string camera = "  pinhole:\n    fx: 500\n    fy: 500\n    cx: 320\n    cy: 240\n    width: 640\n"
                               "    height: 480\n    skew: 0.0\n  model: pinhole_radial_tangential\n"
                               "  radial_tangential:\n    radial:\n    - -0.3\n    - 0.1\n    t1: 0.0\n    t2: 0.0\n";
    const std::string text = "left:\n" + camera +
                             "model: stereo_camera\nrightToLeft:\n  rotation: [0, -1, 0, 1, 0, 0, "
                             "0, 0, 1]\n  x: 120\n  y: 7\n  z: 3\nright:\n" +
                             camera;
    const StereoCalibration found = read(text);
    EXPECT_EQ(found.format, "BoofCV");
    EXPECT_NEAR(found.pose->translation_mm[0], -7, 1e-12);
    EXPECT_NEAR(found.pose->translation_mm[1], 120, 1e-12);
    EXPECT_DOUBLE_EQ(found.right.distortion[1], 0.1);
    EXPECT_REFUSED(read(replaced(text, "model: pinhole_radial_tangential", "model: kannala_brandt")), "kannala_brandt");
}

TEST_F(Calibration, WhatIsRefused)
{
    const std::string good = kIntrinsics + kPose;
    EXPECT_REFUSED(read(""), "is empty");
    EXPECT_REFUSED(read("<?xml version=\"1.0\"?>"), "XML");
    EXPECT_REFUSED(read("just words"), "holds no fields");
    EXPECT_REFUSED(read("a: [1, 2\nb: 3\n"), "rig.yml");
    EXPECT_REFUSED(read("K1: " + std::string(100000, '[')), "rig.yml");
    EXPECT_REFUSED(read(std::string(5000, '-') + "\n" + std::string(1, '\0')), "rig.yml");
    EXPECT_REFUSED(read("f_px 494.1\ncx 317.2\n"), "rig.yml");
    EXPECT_REFUSED(read(replaced(good, "M2:", "X2:")), "K2: is missing");
    EXPECT_REFUSED(read(replaced(good, "R:", "Q:")), "R: is missing");
    EXPECT_REFUSED(read(replaced(good, "cols: 5", "cols: 6")), "rig.yml:10: D1: has 5 values");
    EXPECT_REFUSED(read(replaced(good, "rows: 3", "rows: 4294967296")), "whole number");
    EXPECT_REFUSED(read(replaced(good, "322.5", ".nan")), "finite");
    EXPECT_REFUSED(read(replaced(good, "322.5", "wide")), "rig.yml:9: M1");
    EXPECT_REFUSED(read(replaced(good, "500., 0.,", "-500., 0.,")), "focal");
    EXPECT_REFUSED(read(replaced(good, "500., 0.,", "500., 0.3,")), "skew");
    EXPECT_REFUSED(read(replaced(good, "image_width: 640", "image_width: 0")), "image_width");
    EXPECT_REFUSED(read(replaced(good, "[ 1., 0., 0., 0., 1.", "[ 1., 0., 0., 0., -1.")), "R: is no rotation");
    EXPECT_REFUSED(read(replaced(good, "-60.", "-6e9")), "--unit-mm");
    EXPECT_REFUSED(read(ros("plumb_bob", "0, 0, 0, 0, 0", kLeftP)), "the right one's file");
    EXPECT_REFUSED(read(replaced(kMiddlebury, "doffs=10.25", "doffs=2")), "doffs");
    EXPECT_REFUSED(read(replaced(kMiddlebury, "baseline=193.001", "baseline=wide")), "baseline: is not 1 number");
    EXPECT_REFUSED(read(replaced(kMiddlebury, "cam1=", "cam2=")), "cam1: is missing");
}

TEST_F(Calibration, RosPairsThatDoNotFit)
{
    const std::string left = ros("plumb_bob", "0, 0, 0, 0, 0", kLeftP);
    const std::string right = ros("plumb_bob", "0, 0, 0, 0, 0", kRightP);
    EXPECT_REFUSED(read_two(right, left), "left.yaml");
    EXPECT_REFUSED(read_two(left, left), "exchange");
    EXPECT_REFUSED(read_two(left, replaced(right, "plumb_bob", "thin_prism")), "thin_prism");
    EXPECT_REFUSED(read_two(left, replaced(right, "image_width: 320", "image_width: 640")), "differ in size");
    EXPECT_REFUSED(read_two(left, replaced(right, "0, 240, 120", "0, 240, 121")), "cy differs");
    EXPECT_REFUSED(read_two(left, replaced(right, "-14.4, 0, 240, 120, 0,", "0, 0, 240, 120, -14.4,")), "above");
    EXPECT_REFUSED(read_two(left, replaced(right, "[0, 0, 0, 0, 0]", "[0, 0, 0, 0, .inf]")), "finite");
}

TEST_F(Calibration, PairsThatCannotBeRectified)
{
    const std::string good = kIntrinsics + kPose;
    const auto rectify = [&](const std::string &t, ImageSize output = {}) {
        RectifyOptions options;
        options.output = output;
        return rectify_calibration(read(replaced(good, "-60., 0.5, 0.", t)), options);
    };
    EXPECT_REFUSED(rectify("-5., 0.5, -60."), "epipole");
    EXPECT_REFUSED(rectify("-50., 0., -60."), "epipole");
    EXPECT_REFUSED(rectify("3., -60., 0."), "one above the other");
    EXPECT_REFUSED(rectify("60., 0., 0."), "exchange");
    EXPECT_REFUSED(rectify("-60., 0., 0.", {641, 480}), "641x480");
    EXPECT_REFUSED(rectify("-60., 0., 0.", {8, 8}), "8x8");
}

TEST_F(Calibration, EveryPixelOfADefaultViewIsSeen)
{
    const Rectification rectification = rectify_calibration(read(kIntrinsics + kPose), {});
    for (const bool right : {false, true}) {
        for (int i = 0; i < 640 * 480; i += 7) {
            const Point2 seen =
                rectification.source_position(right, {static_cast<double>(i % 640), static_cast<double>(i / 640)});
            ASSERT_GE(seen.x, -1e-3);
            ASSERT_LE(seen.x, 639.001);
            ASSERT_GE(seen.y, -1e-3);
            ASSERT_LE(seen.y, 479.001);
        }
    }
}

TEST_F(Calibration, TheHeaderHoldsTheTable)
{
    const Rectification rectification = rectify_calibration(read(kMiddlebury), {});
    const RectifyTable table = make_rectify_table(rectification, 32, "calib.txt");
    const std::string text = rectify_c_header(table, rectification, "porch");
    EXPECT_NE(text.find("static const uint8_t porch[" + std::to_string(table.bytes.size()) + "]"), std::string::npos);
    EXPECT_NE(text.find("0x54, 0x53, 0x52, 0x4d, 0x01, 0x05,"), std::string::npos);
    EXPECT_NE(text.find("#define PORCH_KEPT_LEN 320u"), std::string::npos);
}

} // namespace
} // namespace tsr

// Rectification beside OpenCV: positions against cv::initUndistortRectifyMap over every pixel, pixels against
// cv::remap, turned views against cv::stereoRectify, and, where recorded data is there, rows of real chessboards.
//
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tsr/host/rectification.h"
#include "tsr/host/rectify_table.h"

extern "C" {
#include "tsr/vision/rectify.h"
}

namespace
{

constexpr double kPositionErrorMax = 0.05; // px, everywhere
constexpr double kValueErrorMax = 3;       // gray levels: remap's weights are of 1/32 px, the picture is smooth
constexpr double kValueErrorMean = 0.5;

struct Rig {
    std::string name;
    tsr::StereoCalibration calibration;
    tsr::RectifyOptions options;
};

tsr::Camera make_camera(tsr::ImageSize size, double focal, std::array<double, 12> distortion)
{
    tsr::Camera camera;
    camera.size = size;
    camera.fx = focal;
    camera.fy = focal * 1.004;
    camera.cx = 0.5 * size.width + 3.3;
    camera.cy = 0.5 * size.height - 2.1;
    camera.distortion = distortion;
    return camera;
}

// Turned by angles (radians) about x, y, z, shifted by translation_mm.
Rig make_rig(const std::string &name, const tsr::Camera &left, const tsr::Camera &right, cv::Vec3d turn,
             std::array<double, 3> translation_mm, tsr::ImageSize output)
{
    Rig rig{name, {}, {}};
    rig.calibration.file = name;
    rig.calibration.left = left;
    rig.calibration.right = right;
    cv::Mat rotation;
    cv::Rodrigues(turn, rotation);
    tsr::CameraPose pose;
    std::copy(rotation.begin<double>(), rotation.end<double>(), pose.rotation.begin());
    pose.translation_mm = translation_mm;
    rig.calibration.pose = pose;
    rig.options.output = output;
    return rig;
}

std::vector<Rig> synthetic_rigs()
{
    const tsr::ImageSize vga{640, 480};
    const tsr::Camera barrel = make_camera(vga, 330, {-0.38, 0.15, 0.001, -0.0008, -0.025});
    const tsr::Camera other = make_camera(vga, 335, {-0.36, 0.14, -0.0012, 0.0005, -0.022});
    const tsr::Camera rational = make_camera(vga, 380, {7.2, 3.1, 2e-4, 4e-4, 0.11, 7.6, 5.2, 0.75});
    tsr::Camera fisheye = make_camera(vga, 300, {-0.02, 0.012, -0.01, 0.002});
    fisheye.lens = tsr::LensModel::equidistant;
    const cv::Vec3d small(0.01, -0.02, 0.015);
    const cv::Vec3d toe_in(0.02, 0.12, -0.03);
    std::vector<Rig> rigs = {
        make_rig("barrel 640x480", barrel, other, small, {-60, 0.6, 1}, vga),
        make_rig("barrel 320x240", barrel, other, small, {-60, 0.6, 1}, {320, 240}),
        make_rig("barrel 160x120", barrel, other, small, {-60, 0.6, 1}, {160, 120}),
        make_rig("toe-in 320x240", barrel, other, toe_in, {-100, 4, 9}, {320, 240}),
        make_rig("rational 320x240", rational, rational, small, {-60, 0.6, 1}, {320, 240}),
        make_rig("fisheye 320x240", fisheye, fisheye, small, {-60, 0.6, 1}, {320, 240}),
        make_rig("a wide picture's middle 161x121", barrel, other, small, {-60, 0.6, 1}, {161, 121}),
        make_rig("half way to the whole frame 320x240", barrel, other, small, {-60, 0.6, 1}, {320, 240}),
        make_rig("frames of another size 160x120", barrel, other, small, {-60, 0.6, 1}, {160, 120}),
    };
    rigs[3].options.separate_centres = true;
    rigs[7].options.zoom = 0.5;
    rigs[8].options.source = {320, 240};
    return rigs;
}

std::filesystem::path data_folder()
{
    const char *set = std::getenv("TSR_DATA");
    const char *source = std::getenv("TSR_SOURCE");
    return set != nullptr ? std::filesystem::path(set)
                          : std::filesystem::path(source != nullptr ? source : ".") / "../shared/data";
}

std::vector<double> read_npy(const std::filesystem::path &file)
{
    std::ifstream in(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    if (bytes.size() < 10 || bytes.find("'<f8'") == std::string::npos) {
        return {};
    }
    const std::size_t at = 10 + static_cast<unsigned char>(bytes[8]) + 256u * static_cast<unsigned char>(bytes[9]);
    std::vector<double> values((bytes.size() - at) / sizeof(double));
    std::memcpy(values.data(), bytes.data() + at, values.size() * sizeof(double));
    return values;
}

// The StereoPi rig: focal lengths of a 320x240 camera, T in cm.
tsr::StereoCalibration stereopi(const std::filesystem::path &folder)
{
    tsr::StereoCalibration calibration;
    calibration.file = "stereopi";
    tsr::CameraPose pose;
    for (const bool right : {false, true}) {
        const std::string side = right ? "right" : "left";
        const std::vector<double> k = read_npy(folder / ("cam_mats_" + side + ".npy"));
        const std::vector<double> d = read_npy(folder / ("dist_coefs_" + side + ".npy"));
        tsr::Camera &camera = right ? calibration.right : calibration.left;
        camera.size = {320, 240};
        camera.fx = k.at(0);
        camera.fy = k.at(4);
        camera.cx = k.at(2);
        camera.cy = k.at(5);
        std::copy(d.begin(), d.end(), camera.distortion.begin());
    }
    const std::vector<double> r = read_npy(folder / "rot_mat.npy");
    const std::vector<double> t = read_npy(folder / "trans_vec.npy");
    std::copy(r.begin(), r.end(), pose.rotation.begin());
    pose.translation_mm = {10 * t.at(0), 10 * t.at(1), 10 * t.at(2)};
    calibration.pose = pose;
    return calibration;
}

std::vector<Rig> real_rigs(const std::filesystem::path &folder)
{
    std::vector<Rig> rigs;
    const auto bumblebee = folder / "boofcv_bumblebee2/chess/stereo.yaml";
    const auto pi = folder / "stereopi_chess_320x240";
    for (const tsr::ImageSize size : {tsr::ImageSize{640, 480}, tsr::ImageSize{320, 240}, tsr::ImageSize{160, 120}}) {
        const std::string text = " " + std::to_string(size.width) + "x" + std::to_string(size.height);
        if (std::filesystem::exists(bumblebee)) {
            rigs.push_back({"Bumblebee2" + text, tsr::read_calibration({bumblebee}), {}});
            rigs.back().options.output = size;
        }
        if (std::filesystem::exists(pi / "rot_mat.npy") && size.width <= 320) {
            rigs.push_back({"StereoPi" + text, stereopi(pi), {}});
            rigs.back().options.output = size;
        }
    }
    return rigs;
}

cv::Mat camera_matrix(const tsr::Camera &camera)
{
    return (cv::Mat_<double>(3, 3) << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
}

struct Maps {
    cv::Mat x;
    cv::Mat y;
};

Maps opencv_maps(const tsr::Rectification &rectification, bool right)
{
    const tsr::RectifiedViews &views = rectification.views;
    const tsr::Camera &camera = right ? rectification.right : rectification.left;
    const tsr::Rotation &turn = right ? views.rotation_right : views.rotation_left;
    const cv::Mat rotation = cv::Mat(3, 3, CV_64F, const_cast<double *>(turn.data())).clone();
    const cv::Mat view = (cv::Mat_<double>(3, 3) << views.focal_px, 0, right ? views.cx_right : views.cx_left, 0,
                          views.focal_px, views.cy, 0, 0, 1);
    const cv::Size size(rectification.output.width, rectification.output.height);
    Maps maps;
    if (camera.lens == tsr::LensModel::equidistant) {
        const cv::Mat k(4, 1, CV_64F, const_cast<double *>(camera.distortion.data()));
        cv::fisheye::initUndistortRectifyMap(camera_matrix(camera), k, rotation, view, size, CV_32FC1, maps.x, maps.y);
    } else {
        const cv::Mat k(12, 1, CV_64F, const_cast<double *>(camera.distortion.data()));
        cv::initUndistortRectifyMap(camera_matrix(camera), k, rotation, view, size, CV_32FC1, maps.x, maps.y);
    }
    return maps;
}

cv::Mat smooth_picture(tsr::ImageSize size)
{
    cv::Mat picture(size.height, size.width, CV_8U);
    cv::RNG random(42);
    random.fill(picture, cv::RNG::UNIFORM, 0, 256);
    cv::GaussianBlur(picture, picture, {}, 2.5, 0, cv::BORDER_REPLICATE);
    cv::normalize(picture, picture, 0, 255, cv::NORM_MINMAX);
    return picture;
}

cv::Mat rectify(const tsr_rectify_table &table, tsr_rectify_side side, cv::Mat source)
{
    cv::Mat target(table.height, table.width, CV_8U);
    tsr_rectify work;
    const tsr_gray_view in = {source.data, table.source_width, table.source_height, table.source_width};
    const tsr_gray out = {target.data, table.width, table.height, table.width};
    EXPECT_EQ(tsr_rectify_start(&work, &table, side, in, out), TSR_OK);
    EXPECT_EQ(tsr_rectify_run(&work, table.height), TSR_OK);
    return target;
}

double position_error(const tsr_rectify_table &table, tsr_rectify_side side, const Maps &maps)
{
    double worst = 0;
    for (int y = 0; y < table.height; y++) {
        for (int x = 0; x < table.width; x++) {
            std::int32_t read[2];
            tsr_rectify_position(&table, side, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), read);
            const double seen_x = std::clamp<double>(maps.x.at<float>(y, x), 0, table.source_width - 1);
            const double seen_y = std::clamp<double>(maps.y.at<float>(y, x), 0, table.source_height - 1);
            worst = std::max(worst, std::hypot(read[0] / 256.0 - seen_x, read[1] / 256.0 - seen_y));
        }
    }
    return worst;
}

void compare(const Rig &rig)
{
    SCOPED_TRACE(rig.name);
    const tsr::Rectification rectification = tsr::rectify_calibration(rig.calibration, rig.options);
    const tsr::RectifyTable made = tsr::make_rectify_table(rectification, 0, rig.name);
    tsr_rectify_table table;
    ASSERT_EQ(tsr_rectify_open(&table, made.bytes.data(), made.bytes.size()), TSR_OK);
    const cv::Mat picture = smooth_picture(rectification.source());
    double error = 0;
    double value_error = 0;
    for (const tsr_rectify_side side : {TSR_RECTIFY_LEFT, TSR_RECTIFY_RIGHT}) {
        const Maps maps = opencv_maps(rectification, side == TSR_RECTIFY_RIGHT);
        error = std::max(error, position_error(table, side, maps));
        cv::Mat expected;
        cv::remap(picture, expected, maps.x, maps.y, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
        cv::Mat difference;
        cv::absdiff(rectify(table, side, picture), expected, difference);
        double largest = 0;
        cv::minMaxLoc(difference, nullptr, &largest);
        value_error = std::max(value_error, largest);
        EXPECT_LE(cv::mean(difference)[0], kValueErrorMean);
    }
    EXPECT_LE(error, kPositionErrorMax);
    EXPECT_LE(value_error, kValueErrorMax);
    EXPECT_NEAR(error, std::max(made.error_px[0], made.error_px[1]), 1e-3) << "the command prints another error";
    std::cout << rig.name << ": " << made.bytes.size() << " bytes, step " << made.step << ", position " << error
              << " px, value " << value_error << ", rows above " << made.rows_above[0] << " " << made.rows_above[1]
              << ", kept " << made.kept_len << " bytes, f " << rectification.views.focal_px << ", d0 "
              << rectification.d0_px() << "\n";
}

TEST(OpencvRectify, SyntheticRigs)
{
    for (const Rig &rig : synthetic_rigs()) {
        compare(rig);
    }
}

TEST(OpencvRectify, TurnsAsStereoRectify)
{
    for (const Rig &rig : synthetic_rigs()) {
        SCOPED_TRACE(rig.name);
        const tsr::Rectification ours = tsr::rectify_calibration(rig.calibration, rig.options);
        const tsr::CameraPose &pose = *rig.calibration.pose;
        const cv::Mat rotation(3, 3, CV_64F, const_cast<double *>(pose.rotation.data()));
        const cv::Mat translation(3, 1, CV_64F, const_cast<double *>(pose.translation_mm.data()));
        cv::Mat r1, r2, p1, p2, q;
        cv::stereoRectify(camera_matrix(rig.calibration.left), cv::Mat(), camera_matrix(rig.calibration.right),
                          cv::Mat(), {640, 480}, rotation, translation, r1, r2, p1, p2, q);
        for (int i = 0; i < 9; i++) {
            EXPECT_NEAR(ours.views.rotation_left[i], r1.at<double>(i / 3, i % 3), 1e-9);
            EXPECT_NEAR(ours.views.rotation_right[i], r2.at<double>(i / 3, i % 3), 1e-9);
        }
        EXPECT_NEAR(ours.views.baseline_mm, -p2.at<double>(0, 3) / p2.at<double>(0, 0), 1e-6);
    }
}

TEST(OpencvRectify, RealCalibrations)
{
    const std::vector<Rig> rigs = real_rigs(data_folder());
    if (rigs.empty()) {
        GTEST_SKIP() << "tarsier skipped: test_opencv_rectify: no recorded rigs in ../shared/data";
    }
    for (const Rig &rig : rigs) {
        compare(rig);
    }
}

// Mean |y_left - y_right| in px of the chessboard corners of a rig's rectified pictures; -1: none found.
double row_error(const tsr::StereoCalibration &calibration, const std::filesystem::path &folder, cv::Size corners)
{
    const tsr::Rectification rectification = tsr::rectify_calibration(calibration, {});
    const tsr::RectifyTable made = tsr::make_rectify_table(rectification, 0, calibration.file);
    tsr_rectify_table table;
    EXPECT_EQ(tsr_rectify_open(&table, made.bytes.data(), made.bytes.size()), TSR_OK);
    double sum = 0;
    int count = 0;
    for (const auto &entry : std::filesystem::directory_iterator(folder)) {
        std::string name = entry.path().filename().string();
        if (!name.starts_with("left") || (!name.ends_with(".jpg") && !name.ends_with(".png"))) {
            continue;
        }
        cv::Mat views[2] = {cv::imread(entry.path().string(), cv::IMREAD_GRAYSCALE),
                            cv::imread((folder / name.replace(0, 4, "right")).string(), cv::IMREAD_GRAYSCALE)};
        std::vector<cv::Point2f> found[2];
        bool both = true;
        for (int side = 0; side < 2 && both; side++) {
            const cv::Mat view = rectify(table, static_cast<tsr_rectify_side>(side), views[side]);
            both = cv::findChessboardCorners(view, corners, found[side]);
            if (both) {
                cv::cornerSubPix(view, found[side], {4, 4}, {-1, -1}, {cv::TermCriteria::EPS, 30, 0.01});
            }
        }
        for (std::size_t i = 0; both && i < found[0].size(); i++) {
            sum += std::abs(found[0][i].y - found[1][i].y);
            count++;
        }
    }
    std::cout << calibration.file << ": " << count << " corners, rows differ by " << sum / std::max(count, 1)
              << " px on average\n";
    return count > 0 ? sum / count : -1;
}

TEST(OpencvRectify, RowsOfRealChessboardsMeet)
{
    const std::filesystem::path folder = data_folder();
    const auto bumblebee = folder / "boofcv_bumblebee2/chess";
    const auto pi = folder / "stereopi_chess_320x240";
    if (!std::filesystem::exists(bumblebee / "stereo.yaml") || !std::filesystem::exists(pi / "rot_mat.npy")) {
        GTEST_SKIP() << "tarsier skipped: test_opencv_rectify: no recorded chessboards in ../shared/data";
    }
    const double of_bumblebee = row_error(tsr::read_calibration({bumblebee / "stereo.yaml"}), bumblebee, {4, 6});
    EXPECT_GE(of_bumblebee, 0);
    EXPECT_LE(of_bumblebee, 0.3);
    const double of_pi = row_error(stereopi(pi), pi, {9, 6});
    EXPECT_GE(of_pi, 0);
    EXPECT_LE(of_pi, 0.5);
}

} // namespace

/*
 * Calibrations of stereo cameras, as other programs write them.
 *
 *   OpenCV      cv::FileStorage YAML, one file or two (intrinsics and
 *               extrinsics): K1 D1 K2 D2 (or M1, cameraMatrix1, distCoeffs1 ...)
 *               with R T, or R1 R2 P1 P2
 *   ROS         camera_info YAML, one file per camera, left first:
 *               plumb_bob, rational_polynomial, equidistant
 *   BoofCV      stereo YAML of two pinhole_radial_tangential cameras
 *   Middlebury  calib.txt of a pair that is rectified already
 *
 * Conventions are OpenCV's: X_right = R X_left + T, camera axes x right, y down,
 * z forward, pixel (0, 0) is the centre of the top left pixel.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_CALIBRATION_H
#define TSR_HOST_CALIBRATION_H

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tsr/host/image_file.h"

namespace tsr
{

using Rotation = std::array<double, 9>; /* row-major */
inline constexpr Rotation kNoRotation{1, 0, 0, 0, 1, 0, 0, 0, 1};

struct Point2 {
    double x = 0;
    double y = 0;
};

enum class LensModel {
    polynomial, /* k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4: plumb_bob, rational, thin prism */
    equidistant /* k1 k2 k3 k4, OpenCV's fisheye model */
};

struct Camera {
    ImageSize size;
    double fx = 0; /* px */
    double fy = 0;
    double cx = 0;
    double cy = 0;
    LensModel lens = LensModel::polynomial;
    std::array<double, 12> distortion{};

    /* Where the ray (x, y, 1) is seen, px; docs/math.md, eq. (69). */
    Point2 project(Point2 ray) const;
    /* The ray of a pixel, by iteration: for pixels near the middle. */
    Point2 unproject(Point2 pixel) const;
    /* Beyond this radius of the ray the model folds back: pixels there show
     * something else. Infinity if it never does. */
    double radius_max() const;
    /* The same camera giving frames of another size: scaled to cover it, the
     * middle cut out. */
    Camera resized(ImageSize frame) const;
};

/* A rectified pair of views: the same f and cy, rows aligned. */
struct RectifiedViews {
    Rotation rotation_left = kNoRotation; /* camera to view */
    Rotation rotation_right = kNoRotation;
    double focal_px = 0;
    double cx_left = 0;
    double cx_right = 0;
    double cy = 0;
    double baseline_mm = 0;
};

struct CameraPose { /* X_right = rotation X_left + translation_mm */
    Rotation rotation = kNoRotation;
    std::array<double, 3> translation_mm{};
};

struct StereoCalibration {
    std::string file;   /* for errors */
    std::string format; /* "OpenCV", "ROS", "BoofCV", "Middlebury" */
    Camera left;
    Camera right;
    std::optional<CameraPose> pose;      /* at least one of the two is there */
    std::optional<RectifiedViews> views; /* in px of the calibrated size */
};

struct CalibrationUnits {
    ImageSize size;     /* of the calibrated pictures where the file does not say; 0x0: unknown */
    double unit_mm = 0; /* mm in one unit of T; 0: the format's own, m for ROS and mm otherwise */
};

/* Throws InputError "file:line: field: reason". */
StereoCalibration read_calibration(const std::vector<std::filesystem::path> &files, const CalibrationUnits &units = {});

} // namespace tsr

#endif

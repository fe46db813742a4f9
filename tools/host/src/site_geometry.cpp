/* Is a pair of cameras rectified, as its site says? SPDX-License-Identifier: Apache-2.0 */
#include <cmath>
#include <cstdio>
#include <numbers>

#include <Eigen/Dense>

#include "site_faults.h"

namespace tsr
{
namespace
{

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/* Ours: at 0.5 degrees and f = 300 px rows are off by 2.6 px at the image's
 * border, which a 9x9 window just bears. */
constexpr double kAngleMaxDeg = 0.5;
constexpr double kRotationErrorMax = 1e-3; /* of R'R: matrices are typed with four digits */
constexpr double kBaselineErrorMax = 0.01;

double degrees(double radians)
{
    return radians * 180.0 / std::numbers::pi;
}

std::string one_decimal(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.1f", value);
    return text;
}

Eigen::Matrix3d checked_rotation(const Site &site, const SitePair &pair, const SitePose &pose, const std::string &side)
{
    for (const double metres : pose.position_m) {
        if (!(std::abs(metres) <= kPositionMaxM)) {
            refuse_pair(site, pair, side + ".position_m", "is not finite");
        }
    }
    Eigen::Matrix3d rotation = Eigen::Map<const RowMajor3>(pose.rotation.data());
    const double error = (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
    if (!(error <= kRotationErrorMax)) {
        refuse_pair(site, pair, side + ".rotation", "its columns are not orthonormal");
    }
    if (rotation.determinant() < 0) {
        refuse_pair(site, pair, side + ".rotation", "is a mirror image: its determinant is negative");
    }
    return rotation;
}

/* The left view's epipole is the image of the right camera's centre. */
bool epipole_in_image(const SitePair &pair, const Eigen::Vector3d &baseline_left)
{
    if (baseline_left.z() == 0.0) {
        return false;
    }
    const double x = pair.focal_px * baseline_left.x() / baseline_left.z() + pair.principal_px[0];
    const double y = pair.focal_px * baseline_left.y() / baseline_left.z() + pair.principal_px[1];
    return x >= 0 && x < pair.width && y >= 0 && y < pair.height;
}

} // namespace

void check_pair_geometry(const Site &site, const SitePair &pair)
{
    const Eigen::Matrix3d left = checked_rotation(site, pair, pair.left, "left");
    if (!pair.right) {
        return;
    }
    const Eigen::Matrix3d right = checked_rotation(site, pair, *pair.right, "right");
    const Eigen::Vector3d between =
        Eigen::Vector3d(pair.right->position_m.data()) - Eigen::Vector3d(pair.left.position_m.data());
    const double length_mm = 1000.0 * between.norm();
    if (std::abs(length_mm - pair.baseline_mm) > kBaselineErrorMax * pair.baseline_mm) {
        refuse_pair(site, pair, "right.position_m",
                    "is " + one_decimal(length_mm) + " mm from the left camera, baseline_mm says " +
                        one_decimal(pair.baseline_mm));
    }
    const Eigen::Vector3d baseline_left = left.transpose() * between;
    if (epipole_in_image(pair, baseline_left)) {
        refuse_pair(site, pair, "right.position_m", "the epipole lies in the image: not rectified");
    }
    const double turn_deg = degrees(std::abs(Eigen::AngleAxisd(Eigen::Matrix3d(left.transpose() * right)).angle()));
    if (!(turn_deg <= kAngleMaxDeg)) {
        refuse_pair(site, pair, "right.rotation",
                    "the cameras are turned by " + one_decimal(turn_deg) +
                        " degrees against each other: not rectified");
    }
    const double off_axis_deg =
        degrees(std::atan2(std::hypot(baseline_left.y(), baseline_left.z()), baseline_left.x()));
    if (!(off_axis_deg <= kAngleMaxDeg)) {
        refuse_pair(site, pair, "right.position_m",
                    "the baseline is " + one_decimal(off_axis_deg) +
                        " degrees off the left camera's x axis: not rectified");
    }
}

} // namespace tsr

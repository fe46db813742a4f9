/* Rectified views of a pair of cameras. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/rectification.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "tsr/host/input_error.h"

extern "C" {
#include "tsr/vision/rectify.h"
}

namespace tsr
{
namespace
{

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr double kNearPicture = 0.5; /* an epipole this part of the picture outside its border is near */
constexpr double kDepthMin = 0.05;   /* of a unit ray that can be seen: 87 degrees off the axis */
constexpr int kBisections = 50;
constexpr double kZoomRange = 64; /* f is sought within this factor of the camera's */
constexpr double kD0Step = 1.0 / 16;
constexpr double kEdgeTolerance = 1e-6;

Eigen::Matrix3d matrix_of(const Rotation &rotation)
{
    return Eigen::Map<const RowMajor3>(rotation.data());
}

Rotation values_of(const Eigen::Matrix3d &matrix)
{
    Rotation rotation;
    Eigen::Map<RowMajor3>(rotation.data()) = matrix;
    return rotation;
}

[[noreturn]] void refuse(const StereoCalibration &calibration, const std::string &field, const std::string &reason)
{
    throw InputError(calibration.file, field, reason);
}

/* direction: from this camera to the other one. */
void check_epipole(const StereoCalibration &calibration, const Camera &camera, const Eigen::Vector3d &direction)
{
    if (std::abs(direction.z()) < 1e-9 * direction.norm()) {
        return;
    }
    const double x = camera.fx * direction.x() / direction.z() + camera.cx;
    const double y = camera.fy * direction.y() / direction.z() + camera.cy;
    const double width = camera.size.width;
    const double height = camera.size.height;
    if (x > -kNearPicture * width && x < (1 + kNearPicture) * width && y > -kNearPicture * height &&
        y < (1 + kNearPicture) * height) {
        refuse(calibration, "T",
               "the epipole lies in or near the picture, at (" + std::to_string(std::lround(x)) + ", " +
                   std::to_string(std::lround(y)) + "): one camera stands ahead of the other");
    }
}

/* The least turn from one direction to another that is not opposite. Eigen's FromTwoVectors does those as well, by a
 * singular value decomposition that takes half of this file's compile time. */
Eigen::Quaterniond turn_to(const Eigen::Vector3d &from, const Eigen::Vector3d &to)
{
    const Eigen::Vector3d start = from.normalized();
    const Eigen::Vector3d end = to.normalized();
    const double twice_w = std::sqrt((1 + end.dot(start)) * 2);
    Eigen::Quaterniond turn;
    turn.vec() = start.cross(end) * (1 / twice_w);
    turn.w() = twice_w * 0.5;
    return turn;
}

/* Eq. (70). */
void turn_views(const StereoCalibration &calibration, RectifiedViews &views)
{
    const CameraPose &pose = *calibration.pose;
    const Eigen::Matrix3d rotation = Eigen::Quaterniond(matrix_of(pose.rotation)).normalized().toRotationMatrix();
    const Eigen::Vector3d shift(pose.translation_mm.data());
    check_epipole(calibration, calibration.left, -(rotation.transpose() * shift));
    check_epipole(calibration, calibration.right, shift);
    const Eigen::AngleAxisd whole(rotation);
    const Eigen::Matrix3d half = Eigen::AngleAxisd(-0.5 * whole.angle(), whole.axis()).toRotationMatrix();
    const Eigen::Vector3d towards = half * shift;
    if (std::abs(towards.y()) > std::abs(towards.x())) {
        refuse(calibration, "T",
               "the cameras stand one above the other: turn both pictures by 90 degrees and calibrate again");
    }
    if (towards.x() >= 0) {
        refuse(calibration, "T", "the right camera is not on the right: exchange the cameras");
    }
    const Eigen::Matrix3d align = turn_to(towards, -Eigen::Vector3d::UnitX()).toRotationMatrix();
    views.rotation_left = values_of(align * half.transpose());
    views.rotation_right = values_of(align * half);
    views.baseline_mm = shift.norm();
}

/* The views of one calibration at any focal length. */
class Zoom
{
  public:
    Zoom(const Rectification &rectification, bool separate_centres)
        : trial_(rectification), limits_{rectification.left.radius_max(), rectification.right.radius_max()}
    {
        for (int side = 0; side < 2; side++) {
            const Camera &camera = side == 0 ? trial_.left : trial_.right;
            const Point2 ray = camera.unproject({0.5 * (camera.size.width - 1), 0.5 * (camera.size.height - 1)});
            const Rotation &rotation = side == 0 ? trial_.views.rotation_left : trial_.views.rotation_right;
            const Eigen::Vector3d turned = matrix_of(rotation) * Eigen::Vector3d(ray.x, ray.y, 1);
            middle_[side] = {turned.x() / turned.z(), turned.y() / turned.z()};
        }
        if (!separate_centres) {
            middle_[0].x = middle_[1].x = 0.5 * (middle_[0].x + middle_[1].x);
        }
        middle_[0].y = middle_[1].y = 0.5 * (middle_[0].y + middle_[1].y);
    }

    RectifiedViews at(double focal_px) const
    {
        RectifiedViews views = trial_.views;
        views.focal_px = focal_px;
        views.cx_left = 0.5 * (trial_.output.width - 1) - focal_px * middle_[0].x;
        views.cx_right = 0.5 * (trial_.output.width - 1) - focal_px * middle_[1].x;
        views.cy = 0.5 * (trial_.output.height - 1) - focal_px * middle_[0].y;
        return views;
    }

    /* Every pixel on the border and on a grid inside it is seen in its frame. */
    bool is_filled(double focal_px)
    {
        return for_all(focal_px, false, [](bool inside) { return inside; });
    }

    /* No pixel on the border is seen: the border is round the frame. */
    bool is_whole(double focal_px)
    {
        return for_all(focal_px, true, [](bool inside) { return !inside; });
    }

  private:
    template <typename Question> bool for_all(double focal_px, bool border_only, Question question)
    {
        trial_.views = at(focal_px);
        const int last_x = trial_.output.width - 1;
        const int last_y = trial_.output.height - 1;
        for (int y = 0; y <= last_y; y++) {
            const bool edge = y == 0 || y == last_y || (!border_only && y % 16 == 0);
            for (int x = 0; x <= last_x; x += edge ? 1 : last_x) {
                if (!question(is_inside(false, x, y)) || !question(is_inside(true, x, y))) {
                    return false;
                }
            }
        }
        return true;
    }

    bool is_inside(bool right, int x, int y) const
    {
        const RectifiedViews &views = trial_.views;
        const Camera &camera = right ? trial_.right : trial_.left;
        const Eigen::Vector3d view((x - (right ? views.cx_right : views.cx_left)) / views.focal_px,
                                   (y - views.cy) / views.focal_px, 1);
        const Eigen::Vector3d ray = matrix_of(right ? views.rotation_right : views.rotation_left).transpose() * view;
        if (ray.z() < kDepthMin * ray.norm() || std::hypot(ray.x(), ray.y()) > limits_[right ? 1 : 0] * ray.z()) {
            return false;
        }
        const Point2 seen = camera.project({ray.x() / ray.z(), ray.y() / ray.z()});
        return seen.x >= -kEdgeTolerance && seen.x <= camera.size.width - 1 + kEdgeTolerance &&
               seen.y >= -kEdgeTolerance && seen.y <= camera.size.height - 1 + kEdgeTolerance;
    }

    Rectification trial_;
    std::array<double, 2> limits_;
    std::array<Point2, 2> middle_;
};

/* Between low, where holds is false, and high, where it is true, or the other way round. */
template <typename Holds> double bisect(double yes, double no, Holds holds)
{
    for (int i = 0; i < kBisections; i++) {
        const double middle = std::sqrt(yes * no);
        (holds(middle) ? yes : no) = middle;
    }
    return yes;
}

RectifiedViews zoomed(const StereoCalibration &calibration, const Rectification &rectification,
                      const RectifyOptions &options)
{
    Zoom zoom(rectification, options.separate_centres);
    const double scale = static_cast<double>(rectification.output.width) / rectification.left.size.width;
    const double camera_focal = scale * std::min(rectification.left.fy, rectification.right.fy);
    const double near = camera_focal * kZoomRange;
    const double far = camera_focal / kZoomRange;
    if (!zoom.is_filled(near)) {
        refuse(calibration, "R", "the two cameras do not look at one scene: no rectified view is seen by both");
    }
    const double filled = bisect(near, far, [&](double focal) { return zoom.is_filled(focal); });
    const double amount = options.zoom.value_or(0.0);
    if (amount == 0.0) {
        return zoom.at(filled);
    }
    if (!zoom.is_whole(far)) {
        refuse(calibration, "--zoom", "the lens is too wide for a view that holds the whole frame: use 0");
    }
    const double whole = bisect(far, filled, [&](double focal) { return zoom.is_whole(focal); });
    return zoom.at(filled + amount * (whole - filled));
}

/* Views in px of the calibrated size, for a view of another size: scaled to cover it, the middle cut out. */
RectifiedViews resized(const RectifiedViews &views, ImageSize from, ImageSize to)
{
    const double scale =
        std::max(static_cast<double>(to.width) / from.width, static_cast<double>(to.height) / from.height);
    const auto moved = [&](double c, int old_length, int length) {
        return (c + 0.5 - 0.5 * old_length) * scale + 0.5 * length - 0.5;
    };
    RectifiedViews sized = views;
    sized.focal_px *= scale;
    sized.cx_left = moved(views.cx_left, from.width, to.width);
    sized.cx_right = moved(views.cx_right, from.width, to.width);
    sized.cy = moved(views.cy, from.height, to.height);
    return sized;
}

void check_frame(ImageSize size, const std::string &field)
{
    if (size.width < TSR_RECTIFY_SIDE_MIN || size.width > TSR_IMAGE_WIDTH_MAX || size.height < TSR_RECTIFY_SIDE_MIN ||
        size.height > TSR_IMAGE_HEIGHT_MAX) {
        throw InputError("command line", field,
                         std::to_string(size.width) + "x" + std::to_string(size.height) + " is outside " +
                             std::to_string(TSR_RECTIFY_SIDE_MIN) + "x" + std::to_string(TSR_RECTIFY_SIDE_MIN) +
                             " .. " + std::to_string(TSR_IMAGE_WIDTH_MAX) + "x" + std::to_string(TSR_IMAGE_HEIGHT_MAX) +
                             ", which a node can hold");
    }
}

} // namespace

Point2 Rectification::source_position(bool right_view, Point2 pixel) const
{
    const double cx = right_view ? views.cx_right : views.cx_left;
    const Eigen::Vector3d view((pixel.x - cx) / views.focal_px, (pixel.y - views.cy) / views.focal_px, 1);
    const Eigen::Vector3d ray = matrix_of(right_view ? views.rotation_right : views.rotation_left).transpose() * view;
    return (right_view ? right : left).project({ray.x() / ray.z(), ray.y() / ray.z()});
}

Rectification rectify_calibration(const StereoCalibration &calibration, const RectifyOptions &options)
{
    const ImageSize calibrated = calibration.left.size;
    const ImageSize output = options.output == ImageSize{} ? calibrated : options.output;
    const ImageSize source = options.source == ImageSize{} ? output : options.source;
    check_frame(output, "--width, --height");
    check_frame(source, "--source");
    Rectification rectification{calibration.left.resized(source), calibration.right.resized(source), {}, output};
    if (calibration.views) {
        rectification.views = *calibration.views;
    } else {
        turn_views(calibration, rectification.views);
    }
    if (calibration.views && !options.zoom && !options.separate_centres) {
        rectification.views = resized(*calibration.views, calibrated, output);
    } else {
        rectification.views = zoomed(calibration, rectification, options);
    }
    RectifiedViews &views = rectification.views;
    const double d0 = std::round((views.cx_right - views.cx_left) / kD0Step) * kD0Step;
    if (!(std::abs(d0) < 2047)) {
        refuse(calibration, "cx", "the principal points of the views are too far apart");
    }
    views.cx_right = views.cx_left + d0;
    return rectification;
}

} // namespace tsr

/* Which format is it, and what all formats share. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/calibration.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "calibration_readers.h"
#include "tsr/host/input_error.h"
#include "tsr/host/read_file.h"

namespace tsr
{
namespace
{

constexpr std::size_t kFileMax = std::size_t{1} << 20;
constexpr double kRotationErrorMax = 1e-3;
constexpr double kFocalMin = 1.0;
constexpr double kFocalMax = 1e6;
constexpr double kPixelTolerance = 0.01; /* files print some with few digits */
constexpr std::size_t kDistortionMax = 12;

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

[[noreturn]] void refuse(const YamlMatrix &matrix, const std::string &reason)
{
    throw InputError(matrix.where, matrix.name, reason);
}

void check_shape(const YamlMatrix &matrix, int rows, int cols)
{
    if (matrix.rows != rows || matrix.cols != cols) {
        refuse(matrix, "is " + std::to_string(matrix.rows) + "x" + std::to_string(matrix.cols) + ", not " +
                           std::to_string(rows) + "x" + std::to_string(cols));
    }
}

bool is_focal(double value)
{
    return value >= kFocalMin && value <= kFocalMax;
}

StereoCalibration read_one(const std::string &text, const std::filesystem::path &file, const CalibrationUnits &units)
{
    if (text.find("cam0=") != std::string::npos || text.find("cam0 =") != std::string::npos) {
        return read_middlebury(text, file.string());
    }
    const YamlFields fields(text, file.string());
    if (fields.has({"rightToLeft"})) {
        return read_boofcv(fields, units);
    }
    if (fields.has({"camera_matrix"}) && fields.has({"projection_matrix"})) {
        throw InputError(file.string(), "", "is the camera_info of one camera: give the right one's file as well");
    }
    return read_opencv({fields}, units);
}

} // namespace

void check_size(ImageSize size, const std::string &where, const std::string &field)
{
    if (std::min(size.width, size.height) < kCalibratedSideMin ||
        std::max(size.width, size.height) > kCalibratedSideMax) {
        throw InputError(where, field,
                         std::to_string(size.width) + "x" + std::to_string(size.height) + " is outside " +
                             std::to_string(kCalibratedSideMin) + " .. " + std::to_string(kCalibratedSideMax));
    }
}

void take_camera_matrix(Camera &camera, const YamlMatrix &matrix)
{
    check_shape(matrix, 3, 3);
    const std::vector<double> &k = matrix.values;
    if (!is_focal(k[0]) || !is_focal(k[4])) {
        refuse(matrix, "its focal lengths are not of this world");
    }
    if (k[1] != 0 || k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1) {
        refuse(matrix, "is not [fx 0 cx; 0 fy cy; 0 0 1]: skew is not supported");
    }
    if (!(std::abs(k[2]) <= kFocalMax) || !(std::abs(k[5]) <= kFocalMax)) {
        refuse(matrix, "its principal point is not of this world");
    }
    camera.fx = k[0];
    camera.fy = k[4];
    camera.cx = k[2];
    camera.cy = k[5];
}

void take_distortion(Camera &camera, const YamlMatrix &matrix)
{
    std::vector<double> values = matrix.values;
    if (camera.lens == LensModel::equidistant && values.size() != 4) {
        refuse(matrix, "has " + std::to_string(values.size()) + " coefficients, an equidistant lens has 4");
    }
    while (values.size() > kDistortionMax && values.back() == 0) {
        values.pop_back();
    }
    if (values.size() > kDistortionMax) {
        refuse(matrix, "tilted sensors (coefficients 13 and 14) are not supported");
    }
    std::copy(values.begin(), values.end(), camera.distortion.begin());
}

Rotation checked_rotation(const YamlMatrix &matrix)
{
    YamlMatrix full = matrix;
    if (matrix.rows * matrix.cols == 3) { /* a rotation vector */
        const Eigen::Vector3d axis(matrix.values.data());
        const Eigen::AngleAxisd turn(axis.norm(), axis.norm() > 0 ? axis.normalized() : Eigen::Vector3d::UnitX());
        full.rows = full.cols = 3;
        full.values.resize(9);
        Eigen::Map<RowMajor3>(full.values.data()) = turn.toRotationMatrix();
    }
    check_shape(full, 3, 3);
    const Eigen::Matrix3d rotation = Eigen::Map<const RowMajor3>(full.values.data());
    const double error = (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
    if (!(error <= kRotationErrorMax) || rotation.determinant() < 0) {
        refuse(matrix, "is no rotation");
    }
    Rotation values;
    std::copy(full.values.begin(), full.values.end(), values.begin());
    return values;
}

RectifiedViews views_of(const YamlMatrix &r1, const YamlMatrix &r2, const YamlMatrix &p1, const YamlMatrix &p2,
                        double unit_mm)
{
    check_shape(p1, 3, 4);
    check_shape(p2, 3, 4);
    const std::vector<double> &left = p1.values;
    const std::vector<double> &right = p2.values;
    const double focal = left[0];
    const double tolerance = 1e-4 * focal;
    if (!is_focal(focal) || std::abs(left[5] - focal) > tolerance || std::abs(right[0] - focal) > tolerance ||
        std::abs(right[5] - focal) > tolerance) {
        refuse(p2, "the rectified views must share one focal length in x and y");
    }
    if (std::abs(left[3]) > 0) {
        refuse(p1, "is not the left camera's: its last column is not zero");
    }
    if (std::abs(right[7]) > std::abs(right[3])) {
        refuse(p2, "the cameras stand one above the other: turn both pictures by 90 degrees and calibrate again");
    }
    if (!(right[3] < 0)) {
        refuse(p2, "the right camera is not on the right: exchange the cameras");
    }
    if (std::abs(left[6] - right[6]) > kPixelTolerance) {
        refuse(p2, "the rectified views do not share a row: cy differs");
    }
    RectifiedViews views;
    views.rotation_left = checked_rotation(r1);
    views.rotation_right = checked_rotation(r2);
    views.focal_px = focal;
    views.cx_left = left[2];
    views.cx_right = right[2];
    views.cy = left[6];
    views.baseline_mm = -right[3] / right[0] * unit_mm;
    return views;
}

StereoCalibration read_calibration(const std::vector<std::filesystem::path> &files, const CalibrationUnits &units)
{
    if (files.empty() || files.size() > 2) {
        throw InputError("command line", "CALIBRATION", "give one file, or two");
    }
    std::vector<std::string> texts;
    for (const std::filesystem::path &file : files) {
        texts.push_back(read_text_file(file, kFileMax));
        if (texts.back().find_first_not_of(" \t\r\n") == std::string::npos) {
            throw InputError(file.string(), "", "is empty");
        }
        if (texts.back().starts_with("<")) {
            throw InputError(file.string(), "", "is XML: save it as YAML (cv::FileStorage writes what the name says)");
        }
    }
    if (files.size() == 1) {
        return read_one(texts[0], files[0], units);
    }
    const YamlFields first(texts[0], files[0].string());
    const YamlFields second(texts[1], files[1].string());
    if (first.has({"projection_matrix"}) && second.has({"projection_matrix"})) {
        return read_ros(first, second, units);
    }
    return read_opencv({first, second}, units);
}

} // namespace tsr

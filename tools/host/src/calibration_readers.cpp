/* OpenCV, ROS, BoofCV and Middlebury. SPDX-License-Identifier: Apache-2.0 */
#include "calibration_readers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include <Eigen/Dense>

#include "tsr/host/input_error.h"

namespace tsr
{
namespace
{

constexpr double kMillimetresPerMetre = 1000.0;
constexpr double kBaselineMaxMm = 65000.0; /* of the table */
constexpr double kBaselineMinMm = 1.0;

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

double unit_or(const CalibrationUnits &units, double fallback)
{
    return units.unit_mm > 0 ? units.unit_mm : fallback;
}

void check_baseline(double baseline_mm, const std::string &where, const std::string &field)
{
    if (!(baseline_mm >= kBaselineMinMm && baseline_mm <= kBaselineMaxMm)) {
        std::ostringstream reason;
        reason << "a baseline of " << baseline_mm << " mm is outside " << kBaselineMinMm << " .. " << kBaselineMaxMm
               << ": say with --unit-mm how long its unit is";
        throw InputError(where, field, reason.str());
    }
}

/* The first file that has the field; the first file if none has. */
const YamlFields &holder(const std::vector<YamlFields> &files, Names names)
{
    const auto found = std::find_if(files.begin(), files.end(), [&](const YamlFields &f) { return f.has(names); });
    return found != files.end() ? *found : files.front();
}

ImageSize opencv_size(const std::vector<YamlFields> &files, const CalibrationUnits &units)
{
    const Names pair_names = {"imageSize", "image_size", "img_size", "size"};
    const Names width_names = {"image_width", "image_Width", "width"};
    const Names height_names = {"image_height", "image_Height", "height"};
    const YamlFields &with_pair = holder(files, pair_names);
    const YamlFields &with_width = holder(files, width_names);
    ImageSize size = units.size;
    if (with_pair.has(pair_names)) {
        const YamlMatrix pair = with_pair.matrix(pair_names);
        if (pair.values.size() != 2) {
            with_pair.refuse(pair_names, "is not a width and a height");
        }
        check_size({static_cast<int>(std::clamp(pair.values[0], 0.0, 1e6)),
                    static_cast<int>(std::clamp(pair.values[1], 0.0, 1e6))},
                   pair.where, pair.name);
        size = {static_cast<int>(pair.values[0]), static_cast<int>(pair.values[1])};
    } else if (with_width.has(width_names)) {
        size = {with_width.integer(width_names), with_width.integer(height_names)};
    }
    if (size == ImageSize{}) {
        throw InputError(files.front().file(), "image_width",
                         "is missing: say with --calibrated WIDTHxHEIGHT how large the calibrated pictures were");
    }
    check_size(size, files.front().file(), "image_width");
    return size;
}

Camera opencv_camera(const std::vector<YamlFields> &files, ImageSize size, Names matrix, Names distortion)
{
    Camera camera;
    camera.size = size;
    take_camera_matrix(camera, holder(files, matrix).matrix(matrix));
    if (const YamlFields &with = holder(files, distortion); with.has(distortion)) {
        take_distortion(camera, with.matrix(distortion));
    }
    return camera;
}

std::map<std::string, std::string> key_values(const std::string &text)
{
    std::map<std::string, std::string> values;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t at = line.find('=');
        if (at != std::string::npos) {
            std::string key = line.substr(0, at);
            key.erase(std::remove(key.begin(), key.end(), ' '), key.end());
            values[key] = line.substr(at + 1);
        }
    }
    return values;
}

/* The numbers of "[f 0 cx; 0 f cy; 0 0 1]" or "3.5". */
std::vector<double> middlebury_numbers(const std::map<std::string, std::string> &values, const std::string &key,
                                       std::size_t count, const std::string &file)
{
    const auto found = values.find(key);
    if (found == values.end()) {
        throw InputError(file, key, "is missing");
    }
    std::string text = found->second;
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == '[' || c == ']' || c == ';' || c == ',' || c == '\r'; },
        ' ');
    std::istringstream in(text);
    std::vector<double> numbers;
    for (double value = 0; in >> value;) {
        numbers.push_back(value);
    }
    if (!in.eof() || numbers.size() != count ||
        !std::all_of(numbers.begin(), numbers.end(), [](double v) { return std::isfinite(v) && std::abs(v) < 1e7; })) {
        throw InputError(file, key, "is not " + std::to_string(count) + (count == 1 ? " number" : " numbers"));
    }
    return numbers;
}

} // namespace

StereoCalibration read_opencv(const std::vector<YamlFields> &files, const CalibrationUnits &units)
{
    StereoCalibration calibration;
    calibration.file = files.front().file();
    calibration.format = "OpenCV";
    const ImageSize size = opencv_size(files, units);
    calibration.left = opencv_camera(files, size, {"K1", "M1", "cameraMatrix1", "camera_matrix_1", "CM1"},
                                     {"D1", "distCoeffs1", "distortion_coefficients_1", "dist1"});
    calibration.right = opencv_camera(files, size, {"K2", "M2", "cameraMatrix2", "camera_matrix_2", "CM2"},
                                      {"D2", "distCoeffs2", "distortion_coefficients_2", "dist2"});
    const double unit_mm = unit_or(units, 1.0);
    const YamlFields &with_p = holder(files, {"P1"});
    if (with_p.has({"P1"})) {
        calibration.views = views_of(with_p.matrix({"R1"}), with_p.matrix({"R2"}), with_p.matrix({"P1"}),
                                     with_p.matrix({"P2"}), unit_mm);
        check_baseline(calibration.views->baseline_mm, with_p.matrix({"P2"}).where, "P2");
        return calibration;
    }
    const YamlFields &with_r = holder(files, {"R", "rotation"});
    const YamlMatrix turn = with_r.matrix({"R", "rotation"});
    const YamlFields &with_t = holder(files, {"T", "translation"});
    const YamlMatrix shift = with_t.matrix({"T", "translation"});
    if (shift.values.size() != 3) {
        with_t.refuse({"T", "translation"}, "is not three numbers");
    }
    CameraPose pose;
    pose.rotation = checked_rotation(turn);
    for (std::size_t i = 0; i < 3; i++) {
        pose.translation_mm[i] = shift.values[i] * unit_mm;
    }
    check_baseline(std::hypot(pose.translation_mm[0], pose.translation_mm[1], pose.translation_mm[2]), shift.where,
                   shift.name);
    calibration.pose = pose;
    return calibration;
}

static Camera ros_camera(const YamlFields &fields)
{
    Camera camera;
    camera.size = {fields.integer({"image_width"}), fields.integer({"image_height"})};
    check_size(camera.size, fields.file(), "image_width");
    const std::string model = fields.has({"distortion_model"}) ? fields.text({"distortion_model"}) : "plumb_bob";
    if (model == "equidistant") {
        camera.lens = LensModel::equidistant;
    } else if (model != "plumb_bob" && model != "rational_polynomial") {
        fields.refuse({"distortion_model"}, "'" + model + "' is none of plumb_bob, rational_polynomial, equidistant");
    }
    take_camera_matrix(camera, fields.matrix({"camera_matrix"}));
    take_distortion(camera, fields.matrix({"distortion_coefficients"}));
    return camera;
}

StereoCalibration read_ros(const YamlFields &left, const YamlFields &right, const CalibrationUnits &units)
{
    StereoCalibration calibration;
    calibration.file = left.file();
    calibration.format = "ROS";
    calibration.left = ros_camera(left);
    calibration.right = ros_camera(right);
    if (calibration.left.size != calibration.right.size) {
        right.refuse({"image_width"}, "the cameras' pictures differ in size");
    }
    const YamlMatrix right_view = right.matrix({"projection_matrix"});
    calibration.views = views_of(left.matrix({"rectification_matrix"}), right.matrix({"rectification_matrix"}),
                                 left.matrix({"projection_matrix"}), right_view, unit_or(units, kMillimetresPerMetre));
    check_baseline(calibration.views->baseline_mm, right_view.where, right_view.name);
    return calibration;
}

static Camera boofcv_camera(const YamlFields &fields)
{
    if (fields.text({"model"}) != "pinhole_radial_tangential") {
        fields.refuse({"model"}, "'" + fields.text({"model"}) + "' is not pinhole_radial_tangential");
    }
    const YamlFields pinhole = fields.map({"pinhole"});
    YamlMatrix matrix{3, 3, {}, pinhole.file(), "pinhole"};
    matrix.values = {pinhole.number({"fx"}),
                     pinhole.number({"skew"}),
                     pinhole.number({"cx"}),
                     0,
                     pinhole.number({"fy"}),
                     pinhole.number({"cy"}),
                     0,
                     0,
                     1};
    Camera camera;
    camera.size = {pinhole.integer({"width"}), pinhole.integer({"height"})};
    check_size(camera.size, pinhole.file(), "width");
    take_camera_matrix(camera, matrix);
    const YamlFields lens = fields.map({"radial_tangential"});
    std::vector<double> radial;
    if (lens.has({"radial"})) {
        radial = lens.matrix({"radial"}).values;
    }
    if (radial.size() > 3) {
        lens.refuse({"radial"}, "has more than 3 coefficients");
    }
    radial.resize(3);
    camera.distortion = {radial[0], radial[1], lens.number({"t1"}), lens.number({"t2"}), radial[2]};
    return camera;
}

StereoCalibration read_boofcv(const YamlFields &file, const CalibrationUnits &units)
{
    StereoCalibration calibration;
    calibration.file = file.file();
    calibration.format = "BoofCV";
    calibration.left = boofcv_camera(file.map({"left"}));
    calibration.right = boofcv_camera(file.map({"right"}));
    if (calibration.left.size != calibration.right.size) {
        throw InputError(file.file(), "right.pinhole", "the cameras' pictures differ in size");
    }
    const YamlFields right_to_left = file.map({"rightToLeft"});
    YamlMatrix matrix = right_to_left.matrix({"rotation"});
    if (matrix.values.size() == 9) {
        matrix.rows = matrix.cols = 3;
    }
    const Rotation values = checked_rotation(matrix);
    const Eigen::Matrix3d turn = Eigen::Map<const RowMajor3>(values.data()).transpose();
    const Eigen::Vector3d centre(right_to_left.number({"x"}), right_to_left.number({"y"}), right_to_left.number({"z"}));
    const Eigen::Vector3d shift = -(turn * centre) * unit_or(units, 1.0);
    CameraPose pose;
    Eigen::Map<RowMajor3>(pose.rotation.data()) = turn;
    pose.translation_mm = {shift.x(), shift.y(), shift.z()};
    check_baseline(shift.norm(), file.file(), "rightToLeft");
    calibration.pose = pose;
    return calibration;
}

StereoCalibration read_middlebury(const std::string &text, const std::string &file)
{
    const auto values = key_values(text);
    const std::vector<double> cam0 = middlebury_numbers(values, "cam0", 9, file);
    const std::vector<double> cam1 = middlebury_numbers(values, "cam1", 9, file);
    const double doffs = middlebury_numbers(values, "doffs", 1, file)[0];
    const double width = middlebury_numbers(values, "width", 1, file)[0];
    const double height = middlebury_numbers(values, "height", 1, file)[0];
    StereoCalibration calibration;
    calibration.file = file;
    calibration.format = "Middlebury";
    Camera &left = calibration.left;
    Camera &right = calibration.right;
    take_camera_matrix(left, {3, 3, cam0, file, "cam0"});
    take_camera_matrix(right, {3, 3, cam1, file, "cam1"});
    left.size = right.size = {static_cast<int>(width), static_cast<int>(height)};
    check_size(left.size, file, "width");
    if (left.fx != right.fx || left.fy != right.fy || left.fx != left.fy || left.cy != right.cy) {
        throw InputError(file, "cam1", "does not fit cam0: f and cy must be equal in a rectified pair");
    }
    if (std::abs(right.cx - left.cx - doffs) > 0.5) {
        throw InputError(file, "doffs", "is not the difference of the principal points of cam1 and cam0");
    }
    RectifiedViews views;
    views.focal_px = left.fx;
    views.cx_left = left.cx;
    views.cx_right = right.cx;
    views.cy = left.cy;
    views.baseline_mm = middlebury_numbers(values, "baseline", 1, file)[0];
    check_baseline(views.baseline_mm, file, "baseline");
    calibration.views = views;
    return calibration;
}

} // namespace tsr

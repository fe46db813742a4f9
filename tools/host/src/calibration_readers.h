/*
 * The readers behind read_calibration(), one per format.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_CALIBRATION_READERS_H
#define TSR_HOST_CALIBRATION_READERS_H

#include <string>
#include <vector>

#include "tsr/host/calibration.h"
#include "yaml_fields.h"

namespace tsr
{

inline constexpr int kCalibratedSideMin = 16;
inline constexpr int kCalibratedSideMax = 16384;

StereoCalibration read_opencv(const std::vector<YamlFields> &files, const CalibrationUnits &units);
StereoCalibration read_ros(const YamlFields &left, const YamlFields &right, const CalibrationUnits &units);
StereoCalibration read_boofcv(const YamlFields &file, const CalibrationUnits &units);
StereoCalibration read_middlebury(const std::string &text, const std::string &file);

/* f, cx and cy of a 3x3 camera matrix; distortion of 0 to 14 coefficients. */
void take_camera_matrix(Camera &camera, const YamlMatrix &matrix);
void take_distortion(Camera &camera, const YamlMatrix &matrix);
Rotation checked_rotation(const YamlMatrix &matrix);
/* R1 R2 P1 P2 as views; P is 3x4, its last column in units of unit_mm. */
RectifiedViews views_of(const YamlMatrix &r1, const YamlMatrix &r2, const YamlMatrix &p1, const YamlMatrix &p2,
                        double unit_mm);
void check_size(ImageSize size, const std::string &where, const std::string &field);

} // namespace tsr

#endif

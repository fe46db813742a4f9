/* Triangulation. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/sink/geometry.h"

#include <algorithm>
#include <stdexcept>

namespace tsr
{
namespace
{

constexpr std::uint8_t kMidGray = 128;
constexpr double kMetresPerMillimetre = 0.001;

double pixels_of(std::uint16_t disparity_q4)
{
    return static_cast<double>(disparity_q4) / TSR_DISPARITY_ONE_Q4;
}

} // namespace

PairGeometry::PairGeometry(const SitePair &pair)
    : focal_px_(pair.focal_px), baseline_m_(pair.baseline_mm * kMetresPerMillimetre), d0_px_(pair.d0_px),
      principal_px_(pair.principal_px[0], pair.principal_px[1]),
      r_site_camera_(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pair.left.rotation.data())),
      position_m_(pair.left.position_m.data())
{
}

std::optional<double> PairGeometry::depth_m(double disparity_px) const
{
    const double shift_px = disparity_px + d0_px_;
    if (!(shift_px > 0.0)) {
        return std::nullopt;
    }
    return focal_px_ * baseline_m_ / shift_px;
}

std::optional<Eigen::Vector3d> PairGeometry::point_camera(double x_px, double y_px, double disparity_px) const
{
    const std::optional<double> z_m = depth_m(disparity_px);
    if (!z_m) {
        return std::nullopt;
    }
    return Eigen::Vector3d((x_px - principal_px_.x()) * *z_m / focal_px_, (y_px - principal_px_.y()) * *z_m / focal_px_,
                           *z_m);
}

std::optional<Eigen::Vector3d> PairGeometry::point_site(double x_px, double y_px, double disparity_px) const
{
    const std::optional<Eigen::Vector3d> p_camera = point_camera(x_px, y_px, disparity_px);
    if (!p_camera) {
        return std::nullopt;
    }
    return Eigen::Vector3d(r_site_camera_ * *p_camera + position_m_);
}

std::vector<CloudPoint> triangulate(const PairGeometry &geometry, const DecodedMap &map, const GrayImage *reference)
{
    if (reference != nullptr && reference->size() != ImageSize{map.info.width, map.info.height}) {
        throw std::invalid_argument("triangulate: the reference image has another size than the map");
    }
    std::vector<CloudPoint> points;
    std::size_t i = 0;
    for (int y = 0; y < map.info.height; y++) {
        for (int x = 0; x < map.info.width; x++, i++) {
            if (map.disparity_q4[i] == TSR_DISPARITY_INVALID) {
                continue;
            }
            const auto p_site = geometry.point_site(x, y, pixels_of(map.disparity_q4[i]));
            if (!p_site) {
                continue;
            }
            const std::uint8_t gray = reference != nullptr ? reference->pixels[i] : kMidGray;
            points.push_back({static_cast<float>(p_site->x()), static_cast<float>(p_site->y()),
                              static_cast<float>(p_site->z()), gray, gray, gray});
        }
    }
    return points;
}

std::size_t count_points(const PairGeometry &geometry, const DecodedMap &map)
{
    return static_cast<std::size_t>(
        std::count_if(map.disparity_q4.begin(), map.disparity_q4.end(), [&](std::uint16_t disparity_q4) {
            return disparity_q4 != TSR_DISPARITY_INVALID && geometry.depth_m(pixels_of(disparity_q4));
        }));
}

} // namespace tsr

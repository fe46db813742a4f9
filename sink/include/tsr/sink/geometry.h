/*
 * From disparity to metric points.
 *
 *   Z = f B / (d + d0)                          docs/math.md, eq. (4)
 *   X = (x - cx) Z / f,  Y = (y - cy) Z / f        eq. (5)
 *   p_site = R (X, Y, Z) + position
 *
 * (x, y) is a pixel's centre in the left, rectified view, x right, y down; f, d,
 * d0, cx, cy in pixels; B, X, Y, Z in metres. Rectified views without lens
 * distortion are assumed (the node or its recording rectifies). d + d0 <= 0 is
 * beyond infinity: no point.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SINK_GEOMETRY_H
#define TSR_SINK_GEOMETRY_H

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Dense>

#include "tsr/host/ply.h"
#include "tsr/host/site.h"
#include "tsr/sink/decoded_map.h"

namespace tsr
{

class PairGeometry
{
  public:
    explicit PairGeometry(const SitePair &pair);

    /* Z of a disparity, metres; nothing if d + d0 <= 0. */
    std::optional<double> depth_m(double disparity_px) const;
    /* Left camera's axes, metres. */
    std::optional<Eigen::Vector3d> point_camera(double x_px, double y_px, double disparity_px) const;
    std::optional<Eigen::Vector3d> point_site(double x_px, double y_px, double disparity_px) const;

  private:
    double focal_px_;
    double baseline_m_;
    double d0_px_;
    Eigen::Vector2d principal_px_;
    Eigen::Matrix3d r_site_camera_;
    Eigen::Vector3d position_m_;
};

/*
 * One point per valid pixel of map, rows from the top, in site coordinates.
 * Gray of the reference image as red = green = blue; mid-gray without one. The
 * reference has the map's size or is null.
 */
std::vector<CloudPoint> triangulate(const PairGeometry &geometry, const DecodedMap &map, const GrayImage *reference);

/* How many points triangulate() makes of it. */
std::size_t count_points(const PairGeometry &geometry, const DecodedMap &map);

} // namespace tsr

#endif

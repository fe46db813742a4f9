/*
 * What one camera sees of a world at an instant, without the sensor.
 *
 * A view keeps its last picture. Light comes in layers, the irradiance of each source times
 * what the surfaces return of it, so that light that grows or fades costs nothing; when bodies
 * move, only pixels that they, or their shadows, can have covered before or
 * cover now are traced again; when the sun has moved on, all are. The result is that of
 * tracing every pixel, bit for bit.
 *
 * Four rays a pixel, on a rotated grid. Surfaces are Lambertian; the sun
 * and the lamp cast shadows.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENE_VIEW_H
#define TSR_SCENE_VIEW_H

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tsr/scene/camera.h"
#include "tsr/scene/ray_caster.h"

namespace tsr::scene
{

/* Returned light of a pixel, by source; [height * width]. */
struct Layers {
    std::vector<float> sky, sun, lamp;

    float radiance(std::size_t pixel, const Light &light) const
    {
        return sky[pixel] * light.sky + sun[pixel] * light.sun + lamp[pixel] * light.lamp;
    }
};

/* Of the pixels' centres. */
struct Truth {
    std::vector<float> depth_m; /* along the optical axis; 0: sky */
    std::vector<ObjectId> objects;
};

class View
{
  public:
    /* Octets that a view keeps for each of its pixels. */
    static constexpr std::size_t kOctetsPerPixel =
        sizeof(Eigen::Vector2f) + 4 * sizeof(Eigen::Vector3f) + 3 * sizeof(float) + 1;

    /* geometry is kept. */
    View(const Geometry &geometry, const Camera &camera);

    const Camera &camera() const { return camera_; }
    /* Exposure of the first row begins at time_us. The result is kept until the next call. */
    const Layers &render(RayCaster &caster, std::uint64_t time_us);
    Truth truth(RayCaster &caster, std::uint64_t time_us) const;

    /* Pixels traced so far. */
    std::uint64_t traced() const { return traced_; }

  private:
    struct Shown { /* a mover in the last picture */
        bool there = false;
        Eigen::Affine3f begin{Eigen::Affine3f::Identity()}, end{Eigen::Affine3f::Identity()};
        bool operator==(const Shown &other) const;
    };

    void trace_pixel(const RayCaster &caster, std::size_t pixel);
    void mark(const std::vector<Eigen::Vector3f> &hull);
    void mark(const Geometry::Mover &mover, const Shown &shown);
    Eigen::Vector3f direction_of(double u, double v) const;

    const Geometry &geometry_;
    Camera camera_;
    Eigen::Vector3f eye_;
    std::vector<Eigen::Vector2f> image_points_;   /* (x', y') of each pixel's centre */
    std::vector<Eigen::AlignedBox2f> row_bounds_; /* of these, row by row */
    std::vector<Eigen::Vector3f> directions_;     /* of each sample, in site axes */
    float margin_ = 0;                            /* how far a pixel reaches beyond its centre in x', y' */
    Layers layers_;
    std::vector<Shown> shown_;
    std::vector<std::uint8_t> dirty_;
    Eigen::Vector3f to_sun_{0, 0, 1};
    std::uint64_t sun_moment_ = UINT64_MAX;
    std::uint64_t traced_ = 0;
};

} // namespace tsr::scene

#endif

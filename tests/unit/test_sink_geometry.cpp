/* Triangulation against numbers worked out by hand and against a projected plane. SPDX-License-Identifier: Apache-2.0
 */
#include <cmath>

#include <gtest/gtest.h>

#include "test_host_site.h"
#include "test_sink_messages.h"
#include "tsr/sink/geometry.h"

namespace tsr
{
namespace
{

/* Motorcycle of Middlebury 2014 at a quarter: Z_mm = 193.001 * 994.978 / (d + 31.086). */
TEST(SinkGeometry, DepthWithOffsetByHand)
{
    SitePair pair = test::pair_of_size("motorcycle", 3, 4, 640, 480);
    pair.focal_px = 994.978;
    pair.baseline_mm = 193.001;
    pair.d0_px = 31.086;
    const PairGeometry geometry(pair);
    EXPECT_NEAR(*geometry.depth_m(40.0), 2.701400, 1e-5); /* 192031.749 / 71.086 mm */
    EXPECT_NEAR(*geometry.depth_m(0.0), 6.177435, 1e-5);  /* 192031.749 / 31.086 mm */
}

TEST(SinkGeometry, PointByHand)
{
    SitePair pair = test::pair_of_size("a", 3, 4, 160, 120);
    pair.focal_px = 200.0;
    pair.baseline_mm = 100.0;
    pair.d0_px = 2.0;
    pair.principal_px = {80.0, 60.0};
    /* f B / (d + d0) = 200 * 0.1 / 10 = 2 m; X = 20 * 2 / 200, Y = -30 * 2 / 200. */
    const auto p = PairGeometry(pair).point_camera(100.0, 30.0, 8.0);
    ASSERT_TRUE(p.has_value());
    EXPECT_NEAR(p->x(), 0.2, 1e-12);
    EXPECT_NEAR(p->y(), -0.3, 1e-12);
    EXPECT_NEAR(p->z(), 2.0, 1e-12);
    /* A camera at (10, 20, 3) that looks along site y: x right = site x, y down = -site z, z forward = site y. */
    pair.left.position_m = {10.0, 20.0, 3.0};
    pair.left.rotation = {1, 0, 0, 0, 0, 1, 0, -1, 0};
    const auto q = PairGeometry(pair).point_site(100.0, 30.0, 8.0);
    EXPECT_NEAR(q->x(), 10.2, 1e-12);
    EXPECT_NEAR(q->y(), 22.0, 1e-12);
    EXPECT_NEAR(q->z(), 3.3, 1e-12);
}

TEST(SinkGeometry, BeyondInfinityThereIsNoPoint)
{
    SitePair pair = test::pair_of_size("a", 3, 4, 32, 24);
    pair.d0_px = -4.0;
    const PairGeometry geometry(pair);
    EXPECT_FALSE(geometry.depth_m(4.0).has_value());
    EXPECT_FALSE(geometry.depth_m(3.0).has_value());
    EXPECT_TRUE(geometry.depth_m(4.0625).has_value());
}

/* A slanted plane is projected into both cameras of a pair; the disparity that
 * follows from the two projections must bring each point back onto the plane. */
TEST(SinkGeometry, ProjectedPlaneComesBack)
{
    SitePair pair = test::pair_of_size("plane", 3, 4, 160, 120);
    pair.focal_px = 180.0;
    pair.baseline_mm = 80.0;
    pair.principal_px = {78.5, 61.25};
    const double right_cx = 84.5;
    const double search_start = 3.0;
    pair.d0_px = search_start + right_cx - pair.principal_px[0];
    const Eigen::AngleAxisd turn(0.7, Eigen::Vector3d(1, 2, -0.5).normalized());
    const Eigen::Matrix3d r_site_camera = turn.toRotationMatrix();
    const Eigen::Vector3d centre_site(4.0, -2.0, 1.5);
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pair.left.rotation.data()) = r_site_camera;
    Eigen::Map<Eigen::Vector3d>(pair.left.position_m.data()) = centre_site;
    const PairGeometry geometry(pair);

    const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.2, -1.0).normalized(); /* left camera's axes */
    const double distance = -2.5;                                                 /* n . p = distance */
    for (int y = 0; y < 120; y += 7) {
        for (int x = 0; x < 160; x += 7) {
            const Eigen::Vector3d ray((x - pair.principal_px[0]) / pair.focal_px,
                                      (y - pair.principal_px[1]) / pair.focal_px, 1.0);
            const Eigen::Vector3d p_left = ray * (distance / normal.dot(ray));
            const Eigen::Vector3d p_right = p_left - Eigen::Vector3d(0.08, 0, 0);
            const double x_right = pair.focal_px * p_right.x() / p_right.z() + right_cx;
            const double disparity = x - search_start - x_right; /* the node shifts the right view */
            const auto p_site = geometry.point_site(x, y, disparity);
            ASSERT_TRUE(p_site.has_value());
            EXPECT_NEAR((*p_site - (r_site_camera * p_left + centre_site)).norm(), 0.0, 1e-9);
        }
    }
}

TEST(SinkGeometry, CloudSkipsInvalidAndTakesTheReferencesGray)
{
    const SitePair pair = test::pair_of_size("a", 3, 4, 32, 24);
    DecodedMap map = test::flat_map(pair, 32);
    map.disparity_q4[0] = TSR_DISPARITY_INVALID;
    const GrayImage reference = test::textured_image(pair);
    const auto points = triangulate(PairGeometry(pair), map, &reference);
    EXPECT_EQ(count_points(PairGeometry(pair), map), points.size());
    ASSERT_EQ(points.size(), 32u * 24u - 1u);
    EXPECT_EQ(points[0].red, reference.pixels[1]);
    EXPECT_EQ(points[0].blue, reference.pixels[1]);
    EXPECT_NEAR(points[0].z_m, 6.0 / 3.5, 1e-6); /* 100 px * 0.06 m / (2 + 1.5) px */
    EXPECT_EQ(triangulate(PairGeometry(pair), map, nullptr)[0].red, 128);
    const GrayImage other{1, 1, {0}};
    EXPECT_THROW(triangulate(PairGeometry(pair), map, &other), std::invalid_argument);
}

} // namespace
} // namespace tsr

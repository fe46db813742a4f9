/*
 * Projection of virtual cameras.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <gtest/gtest.h>

#include "tsr/scene/camera.h"

namespace
{

using tsr::scene::Camera;

TEST(SceneCamera, APinholeProjectsByItsFocalLength)
{
    const Camera camera;
    const Eigen::Vector2d point = tsr::scene::projected(camera, {0.5, -0.25, 2});
    EXPECT_DOUBLE_EQ(point.x(), 79.5 + 160 * 0.25);
    EXPECT_DOUBLE_EQ(point.y(), 59.5 - 160 * 0.125);
}

/* Brown's model written out for one point, by hand. */
TEST(SceneCamera, DistortionFollowsBrown)
{
    Camera camera;
    camera.distortion = {-0.2, 0.05, 0.001, -0.002};
    const double x = 0.3, y = 0.2, r2 = 0.13, radial = 1 - 0.2 * r2 + 0.05 * r2 * r2;
    const Eigen::Vector2d point = tsr::scene::projected(camera, {x, y, 1});
    EXPECT_NEAR(point.x(), 79.5 + 160 * (x * radial + 2 * 0.001 * x * y - 0.002 * (r2 + 2 * x * x)), 1e-9);
    EXPECT_NEAR(point.y(), 59.5 + 160 * (y * radial + 0.001 * (r2 + 2 * y * y) + 2 * -0.002 * x * y), 1e-9);
}

TEST(SceneCamera, UndistortingComesBack)
{
    Camera camera;
    camera.distortion = {-0.25, 0.08, 0.001, -0.001};
    for (const double u : {0.0, 40.0, 159.0}) {
        for (const double v : {0.0, 77.0, 119.0}) {
            const Eigen::Vector2d point = tsr::scene::undistorted(camera, u, v);
            const Eigen::Vector2d back = tsr::scene::projected(camera, {point.x(), point.y(), 1});
            EXPECT_NEAR(back.x(), u, 1e-6);
            EXPECT_NEAR(back.y(), v, 1e-6);
        }
    }
    EXPECT_TRUE(tsr::scene::is_invertible(camera));
}

TEST(SceneCamera, ALensThatFoldsIsFound)
{
    Camera camera;
    camera.distortion = {-2.5, 0, 0, 0};
    EXPECT_FALSE(tsr::scene::is_invertible(camera));
}

TEST(SceneCamera, LookingAtSomethingIsUpright)
{
    const Eigen::Isometry3d pose = tsr::scene::look_at({0, -5, 1.5}, {0, 0, 1.5});
    EXPECT_TRUE(pose.linear().col(2).isApprox(Eigen::Vector3d::UnitY()));
    EXPECT_TRUE(pose.linear().col(0).isApprox(Eigen::Vector3d::UnitX()));
    EXPECT_TRUE(pose.linear().col(1).isApprox(-Eigen::Vector3d::UnitZ()));
    EXPECT_NEAR(pose.linear().determinant(), 1, 1e-12);
}

} // namespace

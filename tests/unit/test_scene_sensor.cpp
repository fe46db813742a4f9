/*
 * The virtual sensor against its model's own mean and variance.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <cmath>

#include <gtest/gtest.h>

#include "tsr/scene/sensor.h"

namespace
{

using namespace tsr::scene;

constexpr int kWidth = 200, kHeight = 150;

struct Shot {
    std::vector<std::uint8_t> pixels = std::vector<std::uint8_t>(kWidth * kHeight);
    tsr_gray image() { return {pixels.data(), kWidth, kHeight, kWidth}; }
    double mean() const
    {
        double sum = 0;
        for (const std::uint8_t pixel : pixels) {
            sum += pixel;
        }
        return sum / static_cast<double>(pixels.size());
    }
    double variance() const
    {
        const double middle = mean();
        double sum = 0;
        for (const std::uint8_t pixel : pixels) {
            sum += (pixel - middle) * (pixel - middle);
        }
        return sum / static_cast<double>(pixels.size());
    }
};

Camera camera()
{
    Camera camera;
    camera.width = kWidth;
    camera.height = kHeight;
    return camera;
}

Layers even(float radiance)
{
    const std::vector<float> none(kWidth * kHeight, 0.0F);
    return {std::vector<float>(kWidth * kHeight, radiance), none, none};
}

const Light kSkyOnly{.sky = 1, .sun = 0, .to_sun = {0, 0, 1}, .lamp = 0};

SensorModel plain()
{
    SensorModel model;
    model.vignetting = 0;
    model.exposure_control = false;
    return model;
}

TEST(SceneSensor, MeanAndVarianceAreTheModels)
{
    for (const float radiance : {0.1F, 0.4F, 1.0F}) {
        SensorModel model = plain();
        Sensor sensor(model);
        Shot shot;
        sensor.expose(camera(), even(radiance), kSkyOnly, shot.image());
        const double electrons = 10'000 * 0.5 * static_cast<double>(radiance); /* a new sensor exposes by half */
        const double to_gray = 255.0 / 10'000;
        EXPECT_NEAR(shot.mean(), electrons * to_gray, 0.1);
        const double expected = (electrons + 15 * 15) * to_gray * to_gray + 1.0 / 12; /* and quantisation */
        EXPECT_NEAR(shot.variance() / expected, 1, 0.05) << radiance;
    }
}

TEST(SceneSensor, WithoutNoiseItIsExactAndClips)
{
    SensorModel model = plain();
    model.noise = false;
    Sensor sensor(model);
    Shot shot;
    sensor.expose(camera(), even(0.8F), kSkyOnly, shot.image());
    EXPECT_EQ(shot.pixels.front(), std::lround(255 * 0.4));
    EXPECT_EQ(shot.variance(), 0);
    sensor.expose(camera(), even(5), kSkyOnly, shot.image());
    EXPECT_EQ(shot.pixels.front(), 255);
}

TEST(SceneSensor, CornersAreDarkerByTheVignetting)
{
    SensorModel model = plain();
    model.noise = false;
    model.vignetting = 0.5F;
    Sensor sensor(model);
    Shot shot;
    sensor.expose(camera(), even(1), kSkyOnly, shot.image());
    EXPECT_NEAR(shot.pixels.front(), 255 * 0.25, 1);
    EXPECT_NEAR(shot.pixels[75 * kWidth + 100], 255 * 0.5, 1);
}

TEST(SceneSensor, ControlReachesTheWantedMeanAndRests)
{
    for (const float radiance : {0.03F, 0.3F, 4.0F}) {
        SensorModel model = plain();
        model.exposure_control = true;
        Sensor sensor(model);
        Shot shot;
        for (int i = 0; i < 20; ++i) {
            sensor.expose(camera(), even(radiance), kSkyOnly, shot.image());
        }
        const float exposure = sensor.exposure(), gain = sensor.gain();
        if (radiance > 0.1F) {
            EXPECT_NEAR(shot.mean(), model.wanted_mean, model.dead_band + 1) << radiance;
        } else {
            EXPECT_EQ(gain, model.gain_max) << "too dark: all it has";
        }
        sensor.expose(camera(), even(radiance), kSkyOnly, shot.image());
        EXPECT_EQ(sensor.exposure(), exposure);
        EXPECT_EQ(sensor.gain(), gain);
    }
}

TEST(SceneSensor, CapturesDifferAndRepeat)
{
    Sensor a(plain()), b(plain());
    Shot first, second, again;
    a.expose(camera(), even(1), kSkyOnly, first.image());
    a.expose(camera(), even(1), kSkyOnly, second.image());
    b.expose(camera(), even(1), kSkyOnly, again.image());
    EXPECT_NE(first.pixels, second.pixels);
    EXPECT_EQ(first.pixels, again.pixels);
}

} // namespace

/*
 * Exposure, noise and quantisation.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/scene/sensor.h"

#include <algorithm>
#include <cmath>

#include "tsr/scene/hash.h"

namespace tsr::scene
{

namespace
{

constexpr float kExposureMin = 1.0F / 64;
constexpr float kExposureMax = 1;
constexpr float kStep = 0.125F;

/* Nearly normal, from 32 bits: the sum of four bytes has mean 510 and variance 4 (256^2 - 1) / 12. */
float normal(std::uint32_t bits)
{
    const auto sum = static_cast<float>((bits & 255) + (bits >> 8 & 255) + (bits >> 16 & 255) + (bits >> 24));
    return (sum - 510.0F) * (1.0F / 147.8F);
}

} // namespace

void Sensor::expose(const Camera &camera, const Layers &layers, const Light &light, const tsr_gray &image)
{
    const float to_electrons = model_.full_well_e * exposure_;
    const float to_gray = 255 * gain_ / model_.full_well_e;
    const float centre_x = static_cast<float>(camera.width - 1) / 2,
                centre_y = static_cast<float>(camera.height - 1) / 2;
    const float falloff = model_.vignetting / (centre_x * centre_x + centre_y * centre_y);
    const std::uint64_t stream = hash64(model_.seed + captures_ * 0x632be59bd9b4e019U);
    std::size_t i = 0;
    for (int y = 0; y < camera.height; ++y) {
        std::uint8_t *row = image.pixels + static_cast<std::size_t>(y) * image.stride;
        const float dy = static_cast<float>(y) - centre_y;
        for (int x = 0; x < camera.width; ++x, ++i) {
            const float dx = static_cast<float>(x) - centre_x;
            const float seen = layers.radiance(i, light) * (1 - falloff * (dx * dx + dy * dy));
            float electrons = std::min(to_electrons * seen, model_.full_well_e);
            if (model_.noise) {
                const std::uint64_t random = hash64(stream + i);
                electrons += std::sqrt(electrons) * normal(static_cast<std::uint32_t>(random)) +
                             model_.read_noise_e * normal(static_cast<std::uint32_t>(random >> 32));
            }
            row[x] = static_cast<std::uint8_t>(std::clamp(electrons * to_gray + 0.5F, 0.0F, 255.0F));
        }
    }
    ++captures_;
    if (model_.exposure_control) {
        control(image);
    }
}

void Sensor::control(const tsr_gray &image)
{
    std::uint64_t sum = 0;
    for (unsigned y = 0; y < image.height; ++y) {
        const std::uint8_t *row = image.pixels + static_cast<std::size_t>(y) * image.stride;
        for (unsigned x = 0; x < image.width; ++x) {
            sum += row[x];
        }
    }
    const float mean = static_cast<float>(sum) / static_cast<float>(image.width * image.height);
    if (std::fabs(mean - model_.wanted_mean) <= model_.dead_band) {
        return;
    }
    const float ratio = std::clamp(model_.wanted_mean / std::max(mean, 1.0F), 0.5F, 2.0F);
    const float stepped = std::nearbyint(ratio / kStep) * kStep;
    const float total = std::clamp(exposure_ * gain_ * stepped, kExposureMin, kExposureMax * model_.gain_max);
    exposure_ = std::min(total, kExposureMax);
    gain_ = std::max(total / kExposureMax, 1.0F);
}

void Sensor::follow(const Sensor &other)
{
    exposure_ = other.exposure_;
    gain_ = other.gain_;
}

} // namespace tsr::scene

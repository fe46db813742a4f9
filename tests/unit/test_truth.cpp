/*
 * A map against ground truth where one of the two or a depth is missing.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <limits>

#include <gtest/gtest.h>

#include "test_host_folder.h"
#include "tsr/emulator/truth.h"

using namespace tsr;
using namespace tsr::test;

namespace
{

constexpr float kNone = std::numeric_limits<float>::infinity();

std::optional<MapError> compare(const std::vector<float> &map, const std::vector<float> &truth, double d0_px = 0)
{
    SitePair pair;
    pair.focal_px = 100;
    pair.baseline_mm = 60;
    pair.d0_px = d0_px;
    const auto row = [](const std::vector<float> &values) {
        return FloatImage{static_cast<int>(values.size()), 1, values};
    };
    return compare_with_truth(row(map), row(truth), pair, "truth.pfm");
}

TEST(Truth, OnlyPixelsWithBothAreMeasured)
{
    const auto error = compare({10, 12, kNone, 7, 20}, {10, 12.75F, 5, kNone, 30});
    ASSERT_TRUE(error);
    EXPECT_EQ(error->truth_pixels, 4u);
    EXPECT_EQ(error->matched_pixels, 3u);
    EXPECT_DOUBLE_EQ(error->correct, 0.5);
    EXPECT_DOUBLE_EQ(error->bad_half.value(), 2.0 / 3);
    EXPECT_DOUBLE_EQ(error->bad_1.value(), 1 - 2.0 / 3);
    EXPECT_DOUBLE_EQ(error->median_px.value(), 0.75);
    EXPECT_DOUBLE_EQ(error->mean_px.value(), 10.75 / 3);
    ASSERT_TRUE(error->median_mm);
    EXPECT_NEAR(*error->median_mm, 6000 / 12.0 - 6000 / 12.75, 1e-9);
    EXPECT_NEAR(*error->median_depth_percent, 100 * 0.75 / 12, 1e-9);
}

TEST(Truth, WithoutTruthThereIsNoError)
{
    EXPECT_FALSE(compare({3, 4}, {kNone, kNone}));
}

/* It has nothing right, and no error either. */
TEST(Truth, AMapWithoutAMatchHasNothingCorrect)
{
    for (const auto &map : {std::vector<float>{kNone, kNone}, {3, kNone}}) {
        const auto error = compare(map, {kNone, 4});
        ASSERT_TRUE(error);
        EXPECT_EQ(error->truth_pixels, 1u);
        EXPECT_EQ(error->matched_pixels, 0u);
        EXPECT_DOUBLE_EQ(error->correct, 0);
        EXPECT_FALSE(error->median_px || error->mean_px || error->bad_half || error->bad_1 || error->median_mm);
    }
}

TEST(Truth, WithoutADepthThereIsNoErrorOfDepth)
{
    const auto error = compare({1, 2}, {0, 0});
    ASSERT_TRUE(error);
    EXPECT_DOUBLE_EQ(error->median_px.value(), 1);
    EXPECT_FALSE(error->median_mm) << "the truth is infinitely far";
    EXPECT_FALSE(error->median_depth_percent);
    EXPECT_FALSE(compare({1, 2}, {1, 2}, -3)->median_mm) << "d + d0 is below 0";
}

TEST(Truth, AnotherSizeIsRefused)
{
    EXPECT_REFUSED(compare({1, 2}, {1, 2, 3}), "truth.pfm: size");
}

} // namespace

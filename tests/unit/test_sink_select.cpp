/* The discard rule at the sink. SPDX-License-Identifier: Apache-2.0 */
#include <gtest/gtest.h>

#include "test_host_folder.h"
#include "test_host_site.h"
#include "test_sink_messages.h"
#include "tsr/sink/select.h"

namespace tsr
{
namespace
{

const SitePair kPair = test::pair_of_size("a", 3, 4, 64, 48);

/* The square [x0, x0 + side) of map set to a value. */
void paint(DecodedMap &map, int x0, int y0, int side, std::uint16_t value)
{
    for (int y = y0; y < y0 + side; y++) {
        for (int x = x0; x < x0 + side; x++) {
            map.disparity_q4[static_cast<std::size_t>(y * map.info.width + x)] = value;
        }
    }
}

TEST(SinkSelect, EqualMapsAreSimilar)
{
    const DecodedMap map = test::flat_map(kPair, 64);
    const MapComparison result = compare_maps(map, map, {});
    EXPECT_TRUE(result.similar);
    EXPECT_EQ(result.mse_px2, 0.0);
    EXPECT_EQ(result.overlap, 1.0);
}

TEST(SinkSelect, MseIsOfPixelsValidInBoth)
{
    const DecodedMap a = test::flat_map(kPair, 64);
    DecodedMap b = test::flat_map(kPair, 64 + 28); /* 1.75 px: 3.0625 px^2 */
    paint(b, 0, 0, 16, TSR_DISPARITY_INVALID);
    const MapComparison result = compare_maps(a, b, {});
    EXPECT_DOUBLE_EQ(result.mse_px2, 3.0625);
    EXPECT_DOUBLE_EQ(result.overlap, 1.0 - 256.0 / (64 * 48));
    EXPECT_EQ(result.different_blocks, 16 * 12 - 16);
    EXPECT_FALSE(result.similar);
}

TEST(SinkSelect, AnObjectOfEightBlocksIsADifferenceAndOneOfFourIsNot)
{
    const DecodedMap a = test::flat_map(kPair, 32);
    DecodedMap b = a;
    paint(b, 8, 8, 8, 128);
    EXPECT_TRUE(compare_maps(a, b, {}).similar);
    paint(b, 24, 8, 8, 128);
    EXPECT_EQ(compare_maps(a, b, {}).different_blocks, 8);
    EXPECT_FALSE(compare_maps(a, b, {}).similar);
    EXPECT_LT(compare_maps(a, b, {}).mse_px2, 2.0); /* which the whole map's MSE would not see */
}

TEST(SinkSelect, FewWildMismatchesAreNoDifference)
{
    const DecodedMap a = test::flat_map(kPair, 0);
    DecodedMap b = a;
    for (std::size_t i = 0; i < b.disparity_q4.size(); i += 10) {
        b.disparity_q4[i] = 240; /* 15 px, clipped to 2 */
    }
    const MapComparison result = compare_maps(a, b, {});
    EXPECT_GT(result.mse_px2, 20.0);
    EXPECT_TRUE(result.similar);
}

TEST(SinkSelect, WhatVanishesIsADifference)
{
    const DecodedMap a = test::flat_map(kPair, 64);
    DecodedMap b = a;
    paint(b, 0, 0, 48, TSR_DISPARITY_INVALID); /* three quarters of the map */
    EXPECT_FALSE(compare_maps(a, b, {}).similar);
    const DecodedMap nothing = test::flat_map(kPair, TSR_DISPARITY_INVALID);
    EXPECT_FALSE(compare_maps(a, nothing, {}).similar);
    EXPECT_TRUE(compare_maps(nothing, nothing, {}).similar);
}

TEST(SinkSelect, ComparesWithTheLastKeptNotTheLastReceived)
{
    const test::Folder folder;
    const SiteThresholds thresholds;
    const Store store(folder / "a.db", 1);
    Selector selector(thresholds, store);
    EXPECT_FALSE(selector.judge(3, test::flat_map(kPair, 32)).has_value());
    EXPECT_TRUE(selector.judge(3, test::flat_map(kPair, 48))->similar);  /* 1 px away */
    EXPECT_FALSE(selector.judge(3, test::flat_map(kPair, 64))->similar); /* 2 px away from the kept one */
    EXPECT_TRUE(selector.judge(3, test::flat_map(kPair, 64))->similar);
    EXPECT_FALSE(selector.judge(5, test::flat_map(kPair, 64)).has_value());
}

TEST(SinkSelect, StartsFromTheStore)
{
    const test::Folder folder;
    const SiteThresholds thresholds;
    Store store(folder / "a.db", 1);
    StoredMap stored;
    stored.node = 3;
    stored.kept = true;
    stored.coded_map = test::code_map(test::flat_map(kPair, 32));
    store.insert(stored);
    Selector selector(thresholds, store);
    const auto result = selector.judge(3, test::flat_map(kPair, 32));
    ASSERT_TRUE(result.has_value());
    EXPECT_TRUE(result->similar);
}

} // namespace
} // namespace tsr

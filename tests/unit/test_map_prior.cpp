/*
 * The prior of maps: that the shipped one was trained for today's matcher, and how one is made.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <algorithm>
#include <regex>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "tsr/coding/map_prior_trainer.h"
#include "tsr/coding/matcher_fingerprint.h"

namespace tsr
{
namespace
{

tsr_map_info info_of(std::uint16_t width, std::uint16_t height)
{
    tsr_map_info info{};
    info.width = width;
    info.height = height;
    info.disparities = 16;
    info.step_log2 = 3;
    return info;
}

/* Multiples of a half pixel, a slope with grains and holes. */
std::vector<std::uint16_t> slope(const tsr_map_info &info)
{
    std::vector<std::uint16_t> map;
    std::uint32_t state = 7;
    for (unsigned y = 0; y < info.height; y++) {
        for (unsigned x = 0; x < info.width; x++) {
            state = state * 1664525U + 1013904223U;
            const unsigned grain = state >> 24U;
            const unsigned label = (x + 2 * y) / 9 + (grain < 20 ? 1 : 0);
            map.push_back(grain > 250 ? TSR_DISPARITY_INVALID : static_cast<std::uint16_t>(8 * label));
        }
    }
    return map;
}

MapPrior prior_of(const tsr_map_info &info, const std::vector<std::uint16_t> &map,
                  const std::vector<std::uint16_t> &reference)
{
    MapPriorTrainer trainer;
    trainer.add(info, map, reference);
    return trainer.train();
}

std::size_t count_numbers(const std::string &text)
{
    static const std::regex number("-?\\d+,");
    return static_cast<std::size_t>(std::distance(std::sregex_iterator(text.begin(), text.end(), number), {}));
}

TEST(MapPrior, WasTrainedForThisMatcher)
{
    EXPECT_EQ(tsr_map_prior_matcher_crc(), matcher_fingerprint())
        << "The matcher's maps have changed, and the map codec's prior was trained for the maps before.\n"
           "Train again (docs/commands.md, tarsier train-prior) with --id one above the present one, write\n"
           "firmware/codec/map_prior.c, and raise the prior in docs/codec.md, 2.1 and 2.8.";
}

TEST(MapPrior, SameMapsGiveTheSamePrior)
{
    const tsr_map_info info = info_of(64, 40);
    const std::vector<std::uint16_t> map = slope(info);
    std::vector<std::uint16_t> earlier = map;
    std::ranges::reverse(earlier);
    for (const auto &reference : {std::vector<std::uint16_t>{}, earlier}) {
        const MapPrior once = prior_of(info, map, reference);
        const MapPrior again = prior_of(info, map, reference);
        EXPECT_EQ(once.weights, again.weights);
        EXPECT_EQ(once.cells, again.cells);
    }
}

TEST(MapPrior, AMapOfOneValueIsFlat)
{
    const tsr_map_info info = info_of(64, 40);
    const std::vector<std::uint16_t> map(std::size_t{64} * 40, 40);
    const MapPrior prior = prior_of(info, map, {});
    /* docs/codec.md, 2.5: 16 pixels and more alike, with a match, NEE and NNE as well. */
    EXPECT_GT(prior.cells[TSR_MAP_CODING_ALONE][2 * 5 + 12 + 24], 65000);
    EXPECT_EQ(prior.cells[TSR_MAP_CODING_ALONE][1 + 2 * 5 + 12 + 24], 32768) << "never without a match";
    EXPECT_EQ(prior.cells[TSR_MAP_CODING_NEAR][2 * 5 + 12 + 24], 32768) << "never near-lossless";
    EXPECT_EQ(prior.cells[TSR_MAP_CODING_REFERENCE][2 + 4 + 8], 32768) << "never against a reference";
    /* The same as the reference. */
    const MapPrior following = prior_of(info, map, map);
    EXPECT_GT(following.cells[TSR_MAP_CODING_REFERENCE][2 + 4 + 8], 65000);
}

TEST(MapPrior, NothingSeenIsUndecided)
{
    const MapPrior prior = MapPriorTrainer{}.train();
    EXPECT_EQ(prior.weights, MapPrior{}.weights);
    EXPECT_EQ(prior.cells[TSR_MAP_CODING_ALONE][0], 32768);
}

TEST(MapPrior, RefusesWhatTheInfoDoesNotAdmit)
{
    const tsr_map_info info = info_of(16, 10);
    const std::vector<std::uint16_t> map(160, 40);
    MapPriorTrainer trainer;
    EXPECT_THROW(trainer.add(info, std::vector<std::uint16_t>(159, 40), {}), std::invalid_argument);
    EXPECT_THROW(trainer.add(info, {}, {}), std::invalid_argument);
    EXPECT_THROW(trainer.add(info, map, std::vector<std::uint16_t>(161, 40)), std::invalid_argument);
    EXPECT_THROW(trainer.add(info, std::vector<std::uint16_t>(160, 41), {}), std::invalid_argument) << "no step";
    EXPECT_THROW(trainer.add(info, std::vector<std::uint16_t>(160, 256), {}), std::invalid_argument) << "16 px";
    EXPECT_THROW(trainer.add(info_of(0, 10), {}, {}), std::invalid_argument);
    EXPECT_THROW(trainer.add(info_of(641, 1), std::vector<std::uint16_t>(641, 40), {}), std::invalid_argument);
    EXPECT_NO_THROW(trainer.add(info, map, map));
}

TEST(MapPrior, SourceHoldsAllNumbers)
{
    const tsr_map_info info = info_of(64, 40);
    const std::string source = map_prior_source(prior_of(info, slope(info), {}), 9, 0x0abc);
    EXPECT_NE(source.find("const struct tsr_map_prior tsr_map_prior = {"), std::string::npos);
    EXPECT_NE(source.find(".id = 9,\n"), std::string::npos);
    EXPECT_NE(source.find(".matcher_crc = 0x0abc,\n"), std::string::npos);
    const std::size_t reference = source.find("const struct tsr_map_reference_prior tsr_map_reference_prior = {");
    ASSERT_NE(reference, std::string::npos);
    constexpr std::size_t kTable = std::size_t{TSR_MAP_KIND_COUNT} * TSR_MAP_TABLE_LEN;
    const std::size_t first = source.find(".weights");
    EXPECT_EQ(count_numbers(source.substr(first, reference - first)),
              kTable * TSR_MAP_TABLE_COUNT_ALONE + std::size_t{TSR_MAP_TRAINED_CELL_COUNT} * TSR_MAP_CODING_REFERENCE);
    EXPECT_EQ(count_numbers(source.substr(reference)),
              kTable * (TSR_MAP_TABLE_COUNT - TSR_MAP_TABLE_COUNT_ALONE) + TSR_MAP_TRAINED_CELL_COUNT);
    for (std::size_t begin = 0, end = 0; (end = source.find('\n', begin)) != std::string::npos; begin = end + 1) {
        EXPECT_LE(end - begin, 120U);
    }
}

} // namespace
} // namespace tsr

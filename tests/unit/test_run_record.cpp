/*
 * What a run gave: records, summary.json and CSV tables say the same as the
 * counters of nodes, MACs, air and sink.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <cmath>
#include <sstream>

#include <numeric>

#include <gtest/gtest.h>

#include "memory_run.h"
#include "tsr/emulator/gallery.h"
#include "tsr/emulator/record_json.h"
#include "tsr/emulator/report.h"
#include "tsr/emulator/table.h"

namespace tsr
{
namespace
{

using test::kBinocular;
using test::kGateway;
using test::kLead;
using test::kRelay;
using test::kWing;
using test::MemoryRun;
using test::short_site;

/* The maps that the sink in memory has, as its exported files would give them. */
std::vector<ReceivedMap> stored_maps(MemoryRun &run)
{
    std::vector<ReceivedMap> maps;
    run.sink.store.for_each([&](const StoredMap &stored) {
        ReceivedMap map;
        map.node = stored.node;
        map.counter = stored.counter;
        map.capture_time_us = run.simulation.virtual_us(stored.node, stored.capture_time_us);
        map.kept = stored.kept;
        map.map_bytes = stored.coded_map.size();
        map.reference_bytes = stored.coded_reference.size();
        map.file = "maps/" + std::to_string(stored.node);
        maps.push_back(map);
    });
    return maps;
}

RunRecord record_of(MemoryRun &run)
{
    return gather(run.site, run.simulation, run.pictures, stored_maps(run), {});
}

/* A lossy run in which maps are delivered. */
Site lossy_site()
{
    Site site = short_site();
    site.radio.frame_loss = 0.05;
    return site;
}

std::vector<std::vector<std::string>> cells_of(const std::string &csv)
{
    std::vector<std::vector<std::string>> lines;
    std::istringstream stream(csv);
    for (std::string text; std::getline(stream, text);) {
        std::vector<std::string> &cells = lines.emplace_back(1);
        for (const char character : text) {
            if (character == ',') {
                cells.emplace_back();
            } else {
                cells.back() += character;
            }
        }
    }
    return lines;
}

std::uint64_t sum_of(const air::LossTally &tally)
{
    return std::accumulate(tally.begin(), tally.end(), std::uint64_t{0});
}

TEST(RunRecord, LinksSumUpToTheAirAndTheMacs)
{
    MemoryRun run(lossy_site());
    run.run();
    const RunRecord record = record_of(run);
    std::map<std::uint16_t, std::uint64_t> frames;
    std::map<std::uint16_t, std::uint64_t> bytes;
    std::map<std::uint16_t, std::uint64_t> acknowledged;
    for (const LinkRecord &link : record.links) {
        const FrameTally data = link.tally.data();
        frames[link.from] += data.frames;
        bytes[link.from] += data.bytes;
        frames[link.to] += link.tally.acknowledgements.frames;
        bytes[link.to] += link.tally.acknowledgements.bytes;
        acknowledged[link.from] += link.tally.acknowledged;
        EXPECT_EQ(link.tally.received + sum_of(link.tally.lost), data.frames) << "each lost frame has one cause";
        EXPECT_LE(link.tally.acknowledged, link.tally.acknowledgements.frames);
        EXPECT_GE(link.snr_db, 20) << "a few metres apart";
        EXPECT_EQ(link.tally.kinds.at(message_index(0)).frames, 0u) << "a frame that nobody can name";
    }
    std::uint64_t lost = 0;
    std::uint64_t faults = 0;
    for (const NodeRecord &node : record.nodes) {
        const std::uint16_t id = node.site->id;
        EXPECT_EQ(frames[id], node.air.frames) << id;
        EXPECT_EQ(bytes[id], node.air.bytes) << id;
        EXPECT_EQ(acknowledged[id], node.mac.sent) << id;
        EXPECT_EQ(sum_of(node.air.lost_by), node.air.lost) << id;
        lost += node.air.lost;
        faults += node.air.lost_by.at(static_cast<std::size_t>(air::LossCause::link_fault));
    }
    EXPECT_GT(lost, 0u);
    EXPECT_GT(faults, 0u) << "frame_loss is a fault of the link";
    EXPECT_EQ(make_summary(record).at("totals").at("air_lost"), lost);
    EXPECT_EQ(make_summary(record).at("totals").at("air_lost_by").at("link_fault"), faults);
}

TEST(RunRecord, KindsAreThoseThatTravel)
{
    MemoryRun run(short_site());
    run.run();
    const RunRecord record = record_of(run);
    const auto bytes = [&](std::uint16_t from, std::uint16_t to, tsr_message_kind kind) {
        for (const LinkRecord &link : record.links) {
            if (link.from == from && link.to == to) {
                return link.tally.kinds.at(message_index(static_cast<std::uint8_t>(kind))).bytes;
            }
        }
        return std::uint64_t{0};
    };
    EXPECT_GT(bytes(kLead, kWing, TSR_MESSAGE_WAKE), 0u);
    EXPECT_EQ(bytes(kWing, kLead, TSR_MESSAGE_WAKE), 0u);
    EXPECT_GT(bytes(kWing, kLead, TSR_MESSAGE_VIEW), 0u);
    EXPECT_EQ(bytes(kRelay, kGateway, TSR_MESSAGE_VIEW), 0u) << "a view stays within its pair";
    EXPECT_GT(bytes(kGateway, kRelay, TSR_MESSAGE_STATUS), 0u);
    EXPECT_EQ(bytes(kGateway, kRelay, TSR_MESSAGE_MAP), 0u);
    for (const auto &[from, to] : {std::pair{kRelay, kGateway}, {kLead, kRelay}, {kBinocular, kRelay}}) {
        EXPECT_GT(bytes(from, to, TSR_MESSAGE_MAP), 0u) << from << " to " << to;
    }
}

TEST(RunRecord, EveryMapHasItsCommit)
{
    MemoryRun run(lossy_site());
    run.run();
    const RunRecord record = record_of(run);
    ASSERT_EQ(record.maps.size(), 4u);
    for (const ReceivedMap &map : record.maps) {
        ASSERT_TRUE(map.commit_time_us) << map.node << ' ' << map.counter;
        EXPECT_GT(*map.commit_time_us, map.capture_time_us + Simulation::kSinkAnswerUs);
        EXPECT_LT(*map.commit_time_us, run.simulation.duration_us());
    }
    /* The captures before and after the change. */
    EXPECT_LT(record.maps[0].commit_time_us, record.maps[1].commit_time_us);
    EXPECT_EQ(record.digest.latency_s.count, 4u);
    EXPECT_GE(record.digest.latency_s.p95, record.digest.latency_s.median);
    EXPECT_EQ(record.simulation->traffic().commits().size(), 4u) << "each message once";
}

void expect_episodes_agree(const Site &site)
{
    MemoryRun run(site);
    run.run();
    const RunRecord record = record_of(run);
    for (const NodeRecord &node : record.nodes) {
        std::map<Fate, std::uint32_t> fates;
        for (const Episode &episode : record.episodes) {
            if (episode.node == node.site->id) {
                ++fates[episode.fate];
                EXPECT_LT(episode.from_us, episode.until_us);
            }
        }
        EXPECT_EQ(fates[Fate::committed], node.counters.maps_sent) << node.site->id;
        EXPECT_EQ(fates[Fate::withheld], node.counters.maps_withheld) << node.site->id;
        EXPECT_EQ(fates[Fate::measured], node.counters.maps_measured) << node.site->id;
        EXPECT_EQ(fates[Fate::lost], node.counters.maps_lost) << node.site->id;
        EXPECT_EQ(fates[Fate::view], node.counters.views_sent + node.counters.views_lost) << node.site->id;
        EXPECT_EQ(fates[Fate::under_way], 0u) << node.site->id;
    }
}

TEST(RunRecord, EpisodesAgreeWithTheCounters)
{
    expect_episodes_agree(lossy_site());
}

/* Two cameras on a board go on watching while their map is under way. */
TEST(RunRecord, EpisodesOfNodesWithZonesAgreeWithTheCounters)
{
    Site site = lossy_site();
    for (SitePair &pair : site.pairs) {
        pair.zones = {SiteZone{"all", pair.name, {0, 0, pair.width, pair.height}, ZoneKind::changed, 0.05}};
        pair.zones[0].every_s = 0.001;
    }
    expect_episodes_agree(site);
}

TEST(RunRecord, ARunThatIsStoppedSaysSo)
{
    MemoryRun whole(short_site());
    whole.run();
    EXPECT_FALSE(make_summary(record_of(whole)).at("stopped").get<bool>());
    MemoryRun part(short_site());
    part.run(700'000);
    EXPECT_TRUE(make_summary(record_of(part)).at("stopped").get<bool>());
    EXPECT_GT(part.simulation.played_us(), part.simulation.duration_us());
}

TEST(RunRecord, TablesSummaryAndCountersSayTheSame)
{
    MemoryRun run(lossy_site());
    run.run();
    const RunRecord record = record_of(run);
    const auto summary = make_summary(record);
    const auto lines = cells_of(csv_of(nodes_table(record)));
    ASSERT_EQ(lines.size(), 1 + record.nodes.size());
    const auto cell = [&](std::size_t line, const std::string &column) {
        const auto found = std::find(lines[0].begin(), lines[0].end(), column);
        EXPECT_NE(found, lines[0].end()) << column;
        return found == lines[0].end() ? "" : lines[line].at(static_cast<std::size_t>(found - lines[0].begin()));
    };
    for (std::size_t i = 0; i < record.nodes.size(); ++i) {
        const EmulatedNode &node = *run.simulation.nodes()[i];
        EXPECT_EQ(lines[i + 1].size(), lines[0].size());
        EXPECT_EQ(cell(i + 1, "id"), std::to_string(node.id()));
        EXPECT_EQ(cell(i + 1, "frames_woken"), std::to_string(node.counters().frames_woken));
        EXPECT_EQ(cell(i + 1, "maps_received"), std::to_string(run.maps_of(node.id()).size()));
        EXPECT_EQ(cell(i + 1, "mac_retries"), std::to_string(node.mac_counters().retries));
        EXPECT_EQ(cell(i + 1, "air_bytes"), std::to_string(run.simulation.air_tally(i).bytes));
        EXPECT_NEAR(std::stod(cell(i + 1, "energy_mj_total")), node.energy().total(), 0.001);
        EXPECT_EQ(summary.at("nodes")[i].at("mac").at("retries"), node.mac_counters().retries);
        EXPECT_EQ(summary.at("nodes")[i].at("energy_mj").at("total").dump(), cell(i + 1, "energy_mj_total"));
    }
    EXPECT_EQ(cell(1, "pair"), "") << "a gateway has no pair";
    EXPECT_EQ(cell(3, "pair"), "porch");
    EXPECT_EQ(cell(3, "hops"), "2");

    std::uint64_t air_bytes = 0;
    for (const auto &entry : summary.at("totals").at("traffic")) {
        air_bytes += entry.at("bytes").get<std::uint64_t>();
    }
    EXPECT_EQ(summary.at("totals").at("air_bytes"), air_bytes);
    EXPECT_EQ(summary.at("links").size(), links_table(record).rows.size());
    EXPECT_EQ(summary.at("pairs")[0].at("maps").size() + summary.at("pairs")[1].at("maps").size(),
              maps_table(record).rows.size());
}

TEST(RunRecord, TablesWithoutRowsHaveTheSameColumns)
{
    MemoryRun run(short_site());
    run.run(1);
    RunRecord empty = record_of(run);
    ASSERT_TRUE(empty.maps.empty());
    const Table none = maps_table(empty);
    ReceivedMap judged;
    judged.error = MapError{};
    judged.error->median_depth_percent = 1;
    empty.maps = {judged, ReceivedMap{}};
    const Table two = maps_table(empty);
    EXPECT_EQ(none.columns, two.columns);
    EXPECT_EQ(csv_of(none).find('\n'), csv_of(none).size() - 1);
    EXPECT_FALSE(two.rows[0].back().is_null());
    EXPECT_TRUE(two.rows[1].back().is_null()) << "not compared with truth";
}

TEST(RunRecord, MapsWithNothingToCompareHaveNoError)
{
    MemoryRun run(short_site());
    run.run(1);
    RunRecord none = record_of(run);
    none.maps.assign(1, ReceivedMap{});
    EXPECT_TRUE(json_of(none.maps[0]).at("error").is_null());
    const auto totals = make_summary(none).at("totals");
    EXPECT_TRUE(totals.at("correct_median").is_null()) << totals.dump();
    EXPECT_EQ(totals.at("error_median_px").at("count"), 0);
}

TEST(RunRecord, NamesAreQuotedInTables)
{
    Table table{{"name", "value"}, {{"left, \"upper\"", 1}, {nullptr, 2.5}}};
    EXPECT_EQ(csv_of(table), "name,value\n\"left, \"\"upper\"\"\",1\n,2.5\n");
}

TEST(RunRecord, NothingIsMinusZero)
{
    for (const double value : {-0.0, -0.0004, 0.0004, 0.0}) {
        EXPECT_EQ(nlohmann::json(rounded(value, 3)).dump(), "0.0") << value;
    }
    EXPECT_EQ(rounded(-0.0006, 3), -0.001);
}

TEST(RunRecord, QuantilesAreNearestRanks)
{
    std::vector<double> values = {3, 1, 2, 4};
    const Quantiles four = quantiles_of(values);
    EXPECT_EQ(four.count, 4u);
    EXPECT_EQ(four.median, 2);
    EXPECT_EQ(four.p95, 4);
    std::vector<double> one = {7};
    EXPECT_EQ(quantiles_of(one).median, 7);
    std::vector<double> none;
    EXPECT_EQ(quantiles_of(none).count, 0u);
    std::vector<double> hundred;
    for (int i = 100; i > 0; --i) {
        hundred.push_back(i);
    }
    EXPECT_EQ(quantiles_of(hundred).p95, 95);
}

TEST(Gallery, ChoosesBestMedianWorstAndNewestOfMany)
{
    const Site site = short_site();
    RunRecord run;
    run.site = &site;
    for (std::uint32_t i = 0; i < 21; ++i) {
        ReceivedMap map;
        map.node = i % 2 == 0 ? kLead : kBinocular;
        map.counter = i;
        map.capture_time_us = 1000 * (i == 20 ? 0 : i);
        map.error = MapError{};
        map.error->correct = (i * 8 % 21) / 21.0;
        run.maps.push_back(map);
    }
    const auto chosen = choose_maps(run);
    ASSERT_EQ(chosen.size(), 4u) << "both pairs are there already";
    EXPECT_EQ(chosen[0].why, "best");
    EXPECT_EQ(chosen[0].map->error->correct, 20 / 21.0);
    EXPECT_EQ(chosen[1].map->error->correct, 10 / 21.0);
    EXPECT_EQ(chosen[2].map->error->correct, 0);
    EXPECT_EQ(chosen[3].why, "newest");
    EXPECT_EQ(chosen[3].map->counter, 19u);
    run.maps.resize(3);
    EXPECT_EQ(choose_maps(run).size(), 3u);
}

TEST(Gallery, ErrorsHaveColours)
{
    const FloatImage truth{4, 1, {2, 2, 2, kFloatInvalid}};
    const FloatImage map{4, 1, {2, 9, kFloatInvalid, 2}};
    const RgbImage image = colour_error(map, truth);
    const auto pixel = [&](std::size_t i) {
        return std::vector<int>(image.pixels.begin() + static_cast<std::ptrdiff_t>(3 * i),
                                image.pixels.begin() + static_cast<std::ptrdiff_t>(3 * i + 3));
    };
    EXPECT_LT(pixel(0)[0] + pixel(0)[1], 100) << "right: dark";
    EXPECT_GT(pixel(1)[0] + pixel(1)[1], 400) << "wrong: bright";
    EXPECT_EQ(pixel(2), (std::vector<int>{110, 110, 110}));
    EXPECT_EQ(pixel(3), (std::vector<int>{0, 0, 0}));
}

} // namespace
} // namespace tsr

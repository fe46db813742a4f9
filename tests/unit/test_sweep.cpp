/*
 * Sweeps: what --sweep takes and refuses, the runs it makes, the table they
 * give.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <gtest/gtest.h>

#include "memory_run.h"
#include "test_host_folder.h"
#include "tsr/emulator/report.h"
#include "tsr/emulator/sweep_report.h"
#include "tsr/host/input_error.h"

namespace tsr
{
namespace
{

using Json = nlohmann::ordered_json;
using Settings = std::vector<std::string>;

std::string refusal(const std::vector<std::string> &options)
{
    try {
        std::vector<SweepAxis> axes;
        for (const std::string &option : options) {
            axes.push_back(parse_sweep(option));
        }
        sweep_points(axes);
    } catch (const InputError &error) {
        return error.what();
    }
    return "";
}

TEST(Sweep, TakesAListOfTomlValues)
{
    const SweepAxis numbers = parse_sweep(" pairs.baseline_mm = 40,1_000, 0.1,-1e3");
    EXPECT_EQ(numbers.key, "pairs.baseline_mm");
    EXPECT_EQ(numbers.values, (std::vector<Json>{40, 1000, 0.1, -1000.0}));
    EXPECT_EQ(parse_sweep("seed=1").values, (std::vector<Json>{1}));
    EXPECT_EQ(parse_sweep("camera.noise=true,false").values, (std::vector<Json>{true, false}));
    EXPECT_EQ(parse_sweep("a.b=\"one, two\",'it = \"3\"'").values, (std::vector<Json>{"one, two", "it = \"3\""}));
    EXPECT_EQ(parse_sweep("a.b=[1, 2],[3, 4]").values, (std::vector<Json>{Json::array({1, 2}), Json::array({3, 4})}));
}

TEST(Sweep, RefusesWhatIsNoListOfValues)
{
    EXPECT_EQ(refusal({"pairs.count"}), "--sweep 'pairs.count': is not TABLE.FIELD=VALUE,VALUE,...");
    for (const char *key : {"", ".", "pairs.", ".count", "pairs..count", "pairs count", "\"pairs\".count"}) {
        EXPECT_NE(refusal({std::string(key) + "=1"}).find("is not TABLE.FIELD"), std::string::npos) << key;
    }
    EXPECT_EQ(refusal({"pairs.count="}), "--sweep 'pairs.count=': has no value");
    EXPECT_EQ(
        refusal({"a.b=1,{c = 2}"}),
        "--sweep 'a.b=1,{c = 2}': value 2: is neither a finite number, a string, true, false nor a list of these");
    for (const char *odd : {"1979-05-27", "inf", "nan", "[1, nan]", "[[{a = 1}]]"}) {
        EXPECT_NE(refusal({std::string("a.b=") + odd}).find("value 1: is neither"), std::string::npos) << odd;
    }
    for (const char *broken : {"one,two", "1,,2", "[1,2", "1 2", "\"a"}) {
        EXPECT_NE(refusal({std::string("a.b=") + broken}).find("': TOML: "), std::string::npos) << broken;
    }
    EXPECT_NE(refusal({"a.b=1]\nother = [2"}).find("is more than a list of values"), std::string::npos);
}

TEST(Sweep, KnowsAFieldInEverySpelling)
{
    for (const char *setting : {"pairs.count=3", " pairs . count = 3", "\"pairs\".count=3", "pairs.'count'=3",
                                "pairs={count=3}", "[pairs]\ncount=3", "# told\npairs.\"co\\u0075nt\" = 3"}) {
        EXPECT_EQ(fields_of(setting), (std::vector<std::string>{"pairs.count"})) << setting;
    }
    EXPECT_EQ(fields_of("a={b={c=1},d=[{e=1}]}"), (std::vector<std::string>{"a.b.c", "a.d"}));
    EXPECT_TRUE(fields_of("pairs.count=one").empty());
}

TEST(Sweep, MakesEveryCombinationTheLastFastest)
{
    const std::vector<SweepAxis> axes = {parse_sweep("a.b=1,2"), parse_sweep("c='x','y',\"z\\\"\"")};
    const auto points = sweep_points(axes);
    ASSERT_EQ(points.size(), 6u);
    EXPECT_EQ(sweep_settings(axes, points[0]), (Settings{"a.b=1", "c=\"x\""}));
    EXPECT_EQ(sweep_settings(axes, points[2]), (Settings{"a.b=1", "c=\"z\\\"\""}));
    EXPECT_EQ(sweep_settings(axes, points[3]), (Settings{"a.b=2", "c=\"x\""}));
}

TEST(Sweep, RefusesAKeyTwiceAndTooManyRuns)
{
    EXPECT_EQ(refusal({"a.b=1", "c=2", "a.b=3"}), "command line: --sweep: a.b is swept twice");
    const std::string ten = "=0,1,2,3,4,5,6,7,8,9";
    EXPECT_EQ(refusal({"a" + ten, "b" + ten, "c" + ten}), "");
    EXPECT_EQ(refusal({"a" + ten, "b" + ten, "c" + ten, "d=1,2"}), "command line: --sweep: makes more than 1000 runs");
}

Json cell(const SweepReport &report, std::size_t row, const std::string &column)
{
    const auto &columns = report.table.columns;
    const auto found = std::find(columns.begin(), columns.end(), column);
    return found == columns.end() ? Json("no such column")
                                  : report.table.rows.at(row).at(static_cast<std::size_t>(found - columns.begin()));
}

TEST(Sweep, ARunWithoutMapsHasNoLatencyAndNoError)
{
    test::MemoryRun run(test::short_site());
    run.run(1); /* stopped at once */
    SweepReport report;
    report.axes = {parse_sweep("a.b=[1, 2]")};
    add_run(report, sweep_points(report.axes)[0], make_summary(gather(run.site, run.simulation, run.pictures, {}, {})),
            "runs/1");
    EXPECT_EQ(report.table.columns.front(), "a.b");
    EXPECT_EQ(report.table.rows[0].front(), "[1,2]");
    EXPECT_EQ(cell(report, 0, "folder"), "runs/1");
    EXPECT_EQ(cell(report, 0, "stopped"), true);
    EXPECT_EQ(cell(report, 0, "nodes"), run.site.nodes.size());
    for (const char *nothing :
         {"latency_s_median", "event_latency_s_median", "error_mean_px", "error_median_mm", "matched", "correct"}) {
        EXPECT_TRUE(cell(report, 0, nothing).is_null()) << nothing;
    }
}

TEST(Sweep, APageHasLargeSeedsWhole)
{
    const test::Folder folder;
    SweepReport report;
    report.axes = {parse_sweep("seed=9007199254740992,9007199254740993,9223372036854775807")};
    report.table = {{"seed", "other"}, {}};
    for (const Json &seed : report.axes[0].values) {
        report.table.rows.push_back({seed, -1});
    }
    write_sweep(folder.path(), report);
    EXPECT_NE(test::read_all(folder / "index.html")
                  .find("[[9007199254740992,-1],[\"9007199254740993\",-1],[\"9223372036854775807\",-1]]"),
              std::string::npos);
    EXPECT_NE(test::read_all(folder / "sweep.csv").find("\n9223372036854775807,-1\n"), std::string::npos);
}

TEST(Sweep, AlignsAndBreaksItsTable)
{
    Table table;
    table.columns = {"key", "word", "number", "x"};
    table.rows = {{1, "a", 2.5, nullptr}, {20, "long word", 100, 7}};
    EXPECT_EQ(aligned_text(table, 1, 0), "key  word       number  x\n"
                                         "  1  a             2.5\n"
                                         " 20  long word     100  7\n");
    EXPECT_EQ(aligned_text(table, 1, 20), "key  word\n"
                                          "  1  a\n"
                                          " 20  long word\n"
                                          "\n"
                                          "key  number  x\n"
                                          "  1     2.5\n"
                                          " 20     100  7\n");
    EXPECT_EQ(aligned_text(table, 1, 1).substr(0, 9), "key  word") << "one column at least";
}

} // namespace
} // namespace tsr

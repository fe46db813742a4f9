/* Exported files: complete, right and equal for equal stores. SPDX-License-Identifier: Apache-2.0 */
#include <cstring>
#include <map>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "test_host_folder.h"
#include "test_host_site.h"
#include "test_sink_messages.h"
#include "tsr/host/pfm.h"
#include "tsr/sink/export.h"
#include "tsr/sink/geometry.h"

namespace tsr
{
namespace
{

using test::Folder;

constexpr int kReferenceErrorMax = 8;

StoredMap stored_of(const SitePair &pair, std::uint32_t counter, const DecodedMap &map, bool kept)
{
    StoredMap stored;
    stored.node = pair.lead;
    stored.counter = counter;
    stored.kept = kept;
    stored.coded_map = test::code_map(map);
    stored.coded_reference = test::code_reference(test::textured_image(pair));
    return stored;
}

std::map<std::string, std::string> files_in(const std::filesystem::path &folder)
{
    std::map<std::string, std::string> files;
    for (const auto &entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file()) {
            files[std::filesystem::relative(entry.path(), folder).string()] = test::read_all(entry.path());
        }
    }
    return files;
}

class SinkExport : public ::testing::Test
{
  protected:
    SinkExport()
    {
        store.insert(stored_of(site.pairs[0], 9, test::flat_map(site.pairs[0], 64), true));
        store.insert(stored_of(site.pairs[0], 10, test::flat_map(site.pairs[0], 64), false));
        StoredMap yard = stored_of(site.pairs[1], 4000000000u, test::flat_map(site.pairs[1], 128), true);
        yard.coded_reference.clear();
        store.insert(yard);
    }

    const Folder folder;
    const Site site = test::small_site();
    Store store{folder / "a.db", site.pan_id};
};

TEST_F(SinkExport, WritesTheStatedFiles)
{
    const ExportResult result = export_site(site, store, {}, folder / "out");
    EXPECT_EQ(result.maps, 3u);
    EXPECT_EQ(result.points, 32u * 24u + 48u * 32u);
    const auto files = files_in(folder / "out");
    std::vector<std::string> names;
    for (const auto &[name, bytes] : files) {
        names.push_back(name);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"cloud.ply", "events.csv", "maps/00003-0000000009-reference.png",
                                               "maps/00003-0000000009.pfm", "maps/00003-0000000009.png",
                                               "maps/00003-0000000010-reference.png", "maps/00003-0000000010.pfm",
                                               "maps/00003-0000000010.png", "maps/00005-4000000000.pfm",
                                               "maps/00005-4000000000.png", "sink.json"}));
    EXPECT_NE(files.at("cloud.ply").find("element vertex 2304\n"), std::string::npos);
    EXPECT_EQ(read_pfm(folder / "out/maps/00003-0000000009.pfm").pixels[7], 4.0F);
    EXPECT_EQ(read_gray_image(folder / "out/maps/00003-0000000009-reference.png").pixels,
              decode_reference(test::code_reference(test::textured_image(site.pairs[0])))->pixels);
}

/* At the finest step the picture is the view's within a few levels of gray. */
TEST_F(SinkExport, ReferenceIsNearTheView)
{
    const GrayImage view = test::textured_image(site.pairs[0]);
    const auto reference = decode_reference(test::code_reference(view));
    ASSERT_TRUE(reference.has_value());
    ASSERT_EQ(reference->size(), view.size());
    for (std::size_t i = 0; i < view.pixels.size(); i++) {
        EXPECT_NEAR(reference->pixels[i], view.pixels[i], kReferenceErrorMax) << i;
    }
}

TEST_F(SinkExport, NumbersAddUp)
{
    SessionNumbers session;
    session.tally.add(Cause::not_authentic, 3);
    session.link.uplinks = 12;
    export_site(site, store, session, folder / "out");
    const auto json = nlohmann::json::parse(test::read_all(folder / "out/sink.json"));
    EXPECT_EQ(json["maps"]["received"], 3);
    EXPECT_EQ(json["maps"]["kept"], 2);
    EXPECT_EQ(json["maps"]["dropped"], 1);
    ASSERT_EQ(json["received"].size(), 3u);
    EXPECT_EQ(json["received"][1]["counter"], 10);
    EXPECT_EQ(json["received"][1]["kept"], false);
    EXPECT_EQ(json["received"][2]["file"], "maps/00005-4000000000");
    EXPECT_EQ(json["nodes"].size(), site.nodes.size());
    EXPECT_EQ(json["nodes"][2]["id"], 3);
    EXPECT_EQ(json["nodes"][2]["maps_dropped"], 1);
    EXPECT_EQ(json["nodes"][4]["maps_kept"], 1);
    EXPECT_EQ(json["session"]["refused"]["not_authentic"], 3);
    EXPECT_EQ(json["session"]["refused"]["store_failed"], 0);
    EXPECT_EQ(json["session"]["link"]["uplinks"], 12);
}

TEST_F(SinkExport, EqualStoresGiveEqualBytes)
{
    export_site(site, store, {}, folder / "first");
    export_site(site, store, {}, folder / "second");
    export_site(site, store, {}, folder / "second"); /* over existing files */
    EXPECT_EQ(files_in(folder / "first"), files_in(folder / "second"));
}

TEST_F(SinkExport, AnEmptyStoreGivesAnEmptyCloud)
{
    const Store empty(folder / "empty.db", site.pan_id);
    EXPECT_EQ(export_site(site, empty, {}, folder / "out").points, 0u);
    EXPECT_NE(test::read_all(folder / "out/cloud.ply").find("element vertex 0\n"), std::string::npos);
}

/* The right half a step nearer: what is exported has a slope between, what is stored has not. */
TEST_F(SinkExport, RestoresWhatItExportsAndNotWhatItStores)
{
    const SitePair &pair = site.pairs[0];
    DecodedMap stairs = test::flat_map(pair, 64);
    for (std::size_t i = 0; i < stairs.disparity_q4.size(); i++) {
        stairs.disparity_q4[i] = i % stairs.info.width < stairs.info.width / 2u ? 64 : 68;
    }
    store.insert(stored_of(pair, 11, stairs, true));
    export_site(site, store, {}, folder / "out");
    const FloatImage exported = read_pfm(folder / "out/maps/00003-0000000011.pfm");
    const DecodedMap expected = restored(stairs);
    EXPECT_NE(expected.disparity_q4, stairs.disparity_q4);
    EXPECT_EQ(exported.pixels, float_disparity(expected.disparity_q4, pair.width, pair.height).pixels);
    EXPECT_EQ(decode_map(store.last_kept(pair.lead)->coded_map)->disparity_q4, stairs.disparity_q4);
    const auto points = triangulate(PairGeometry(pair), expected, nullptr);
    char z[4];
    std::memcpy(z, &points[static_cast<std::size_t>(pair.width) / 2].z_m, sizeof z);
    EXPECT_NE(test::read_all(folder / "out/cloud.ply").find(std::string(z, sizeof z)), std::string::npos);
}

TEST_F(SinkExport, RestoresNoMapThatNoDecoderGives)
{
    EXPECT_THROW(restored(test::flat_map(site.pairs[0], 65)), std::invalid_argument);
}

TEST_F(SinkExport, NamesAFolderItCannotWrite)
{
    folder.put("file", "x");
    EXPECT_REFUSED(export_site(site, store, {}, folder / "file/out"), "file/out");
}

} // namespace
} // namespace tsr

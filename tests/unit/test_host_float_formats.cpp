/* PFM, PLY and colours. SPDX-License-Identifier: Apache-2.0 */
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "test_host_folder.h"
#include "tsr/host/colour_map.h"
#include "tsr/host/pfm.h"
#include "tsr/host/ply.h"

extern "C" {
#include "tsr/base/disparity.h"
}

namespace tsr
{
namespace
{

using test::Folder;
using test::read_all;

FloatImage decode(const std::string &bytes)
{
    return decode_pfm({reinterpret_cast<const std::uint8_t *>(bytes.data()), bytes.size()}, "map.pfm");
}

TEST(HostPfm, RoundTripKeepsInvalid)
{
    const Folder folder;
    const FloatImage image{3, 2, {1.5F, kFloatInvalid, -2.25F, 0.0F, 1e-20F, 31.9375F}};
    write_pfm(folder / "a.pfm", image);
    const FloatImage read = read_pfm(folder / "a.pfm");
    EXPECT_EQ(read.width, 3);
    EXPECT_EQ(read.height, 2);
    EXPECT_EQ(read.pixels, image.pixels);
}

TEST(HostPfm, BytesAreLittleEndianAndBottomRowFirst)
{
    const Folder folder;
    write_pfm(folder / "a.pfm", {1, 2, {1.0F, 2.0F}});
    EXPECT_EQ(read_all(folder / "a.pfm"), std::string("Pf\n1 2\n-1.0\n\0\0\0\x40\0\0\x80\x3f", 20));
}

TEST(HostPfm, ReadsBigEndianAndTurnsNanIntoInvalid)
{
    const FloatImage image = decode(std::string("Pf\n1 2\n1.0\n\x40\0\0\0\x7f\xc0\0\0", 19));
    EXPECT_EQ(image.pixels[1], 2.0F);
    EXPECT_EQ(image.pixels[0], kFloatInvalid);
}

TEST(HostPfm, RefusesWhatLies)
{
    EXPECT_REFUSED(decode("PF\n1 1\n-1\n123456789012"), "magic: not a gray PFM");
    EXPECT_REFUSED(decode("Pf\n1 1\n-1\n123"), "pixels: 3 bytes, the header promises 4");
    EXPECT_REFUSED(decode("Pf\n1 1\n-1\n12345"), "pixels: 5 bytes");
    EXPECT_REFUSED(decode("Pf\n1 1\n0\n1234"), "scale");
    EXPECT_REFUSED(decode("Pf\n1 1\nnan\n1234"), "scale");
    EXPECT_REFUSED(decode("Pf\n1 1\n-1x\n1234"), "scale");
    EXPECT_REFUSED(decode("Pf\n60000 60000\n-1\n1234"), "size");
    EXPECT_REFUSED(decode("Pf\n1"), "height");
}

TEST(HostPfm, DisparitiesBecomePixels)
{
    const std::vector<std::uint16_t> map{0, 8, 16, TSR_DISPARITY_INVALID};
    EXPECT_EQ(float_disparity(map, 4, 1).pixels, (std::vector<float>{0.0F, 0.5F, 1.0F, kFloatInvalid}));
    EXPECT_THROW(float_disparity(map, 3, 1), std::invalid_argument);
}

TEST(HostPly, WritesTheStatedBytes)
{
    const Folder folder;
    const std::vector<CloudPoint> points{{1.0F, -2.0F, 0.5F, 10, 20, 255}, {0, 0, 3.0F, 1, 2, 3}};
    PlyWriter writer(folder / "a.ply", points.size());
    writer.add({points.data(), 1});
    writer.add({points.data() + 1, 1});
    writer.complete();
    const std::string text = read_all(folder / "a.ply");
    const std::size_t body = text.find("end_header\n") + 11;
    EXPECT_EQ(text.rfind("ply\nformat binary_little_endian 1.0\n", 0), 0u);
    EXPECT_NE(text.find("element vertex 2\n"), std::string::npos);
    ASSERT_EQ(text.size() - body, 30u);
    EXPECT_EQ(text.substr(body, 15), std::string("\0\0\x80\x3f\0\0\0\xc0\0\0\0\x3f\x0a\x14\xff", 15));
}

TEST(HostPly, IsThereOnlyWithAllItsPoints)
{
    const Folder folder;
    const std::vector<CloudPoint> points(3);
    PlyWriter writer(folder / "a.ply", 2);
    EXPECT_THROW(writer.add(points), std::logic_error);
    writer.add({points.data(), 1});
    EXPECT_THROW(writer.complete(), std::logic_error);
    EXPECT_FALSE(std::filesystem::exists(folder / "a.ply"));
}

TEST(HostPly, SamplesEvenly)
{
    const Folder folder;
    std::vector<CloudPoint> points;
    for (unsigned i = 0; i < 10; ++i) {
        points.push_back({static_cast<float>(i) - 0.25F, -1e-3F, 7.5F, static_cast<std::uint8_t>(i), 200, 255});
    }
    PlyWriter writer(folder / "a.ply", points.size());
    writer.add(points);
    writer.complete();
    EXPECT_EQ(sample_ply(folder / "a.ply", 10).points, points);
    EXPECT_EQ(sample_ply(folder / "a.ply", 100).points, points);
    const auto [of, some] = sample_ply(folder / "a.ply", 4);
    EXPECT_EQ(of, 10u);
    EXPECT_EQ(some, (std::vector<CloudPoint>{points[0], points[2], points[5], points[7]}));
    EXPECT_TRUE(sample_ply(folder / "a.ply", 0).points.empty());
}

TEST(HostPly, RefusesWhatIsNotItsOwn)
{
    const Folder folder;
    PlyWriter writer(folder / "a.ply", 1);
    writer.add(std::vector<CloudPoint>(1));
    writer.complete();
    const std::string whole = read_all(folder / "a.ply");
    const auto sample = [&](const std::string &content) {
        write_file_atomically(folder / "b.ply", content);
        sample_ply(folder / "b.ply", 1);
    };
    EXPECT_NO_THROW(sample(whole));
    EXPECT_REFUSED(sample(""), "header");
    EXPECT_REFUSED(sample("ply\n"), "header");
    EXPECT_REFUSED(sample(whole.substr(0, whole.size() - 16)), "header");
    EXPECT_REFUSED(sample(whole.substr(0, whole.size() - 1)), "size");
    EXPECT_REFUSED(sample(whole + std::string(15, '\0')), "size");
    EXPECT_REFUSED(sample_ply(folder / "none.ply", 1), "read");
}

TEST(HostColourMap, MatchesViridisAtKnownPlaces)
{
    /* matplotlib 3.6 viridis(0), (0.5), (1) as bytes; tolerance of the polynomial. */
    const auto expect_near = [](double t, int red, int green, int blue) {
        const auto colour = viridis(t);
        EXPECT_NEAR(colour[0], red, 5) << t;
        EXPECT_NEAR(colour[1], green, 5) << t;
        EXPECT_NEAR(colour[2], blue, 5) << t;
    };
    expect_near(0.0, 68, 1, 84);
    expect_near(0.5, 33, 145, 140);
    expect_near(1.0, 253, 231, 37);
    EXPECT_EQ(viridis(-1.0), viridis(0.0));
    EXPECT_EQ(viridis(2.0), viridis(1.0));
    EXPECT_EQ(viridis(std::nan("")), viridis(0.0));
}

TEST(HostColourMap, InvalidIsBlackAndNearIsBright)
{
    const RgbImage image = colour_disparity(std::vector<std::uint16_t>{0, 31 * 16, TSR_DISPARITY_INVALID}, 3, 1, 32);
    EXPECT_EQ(image.pixels[8], 0);
    EXPECT_EQ(image.pixels[6], 0);
    EXPECT_EQ(image.pixels[3], viridis(1.0)[0]);
    EXPECT_EQ(image.pixels[0], viridis(0.0)[0]);
}

} // namespace
} // namespace tsr

/* Image files: formats, luma, limits, damage. SPDX-License-Identifier: Apache-2.0 */
#include <cstdio>

#include <gtest/gtest.h>
#include <jpeglib.h>
#include <sys/stat.h>

#include "test_host_folder.h"
#include "tsr/host/image_file.h"

namespace tsr
{
namespace
{

using test::Folder;
using test::read_all;

GrayImage ramp(int width, int height)
{
    GrayImage image{width, height, {}};
    for (int i = 0; i < width * height; i++) {
        image.pixels.push_back(static_cast<std::uint8_t>(7 * i));
    }
    return image;
}

GrayImage decode(const std::string &bytes)
{
    return decode_gray_image({reinterpret_cast<const std::uint8_t *>(bytes.data()), bytes.size()}, "image");
}

std::string jpeg_of(const GrayImage &image)
{
    jpeg_compress_struct info{};
    jpeg_error_mgr errors{};
    unsigned char *bytes = nullptr;
    unsigned long len = 0;
    info.err = jpeg_std_error(&errors);
    jpeg_create_compress(&info);
    jpeg_mem_dest(&info, &bytes, &len);
    info.image_width = static_cast<JDIMENSION>(image.width);
    info.image_height = static_cast<JDIMENSION>(image.height);
    info.input_components = 1;
    info.in_color_space = JCS_GRAYSCALE;
    jpeg_set_defaults(&info);
    jpeg_set_quality(&info, 95, TRUE);
    jpeg_start_compress(&info, TRUE);
    while (info.next_scanline < info.image_height) {
        auto *row = const_cast<JSAMPROW>(image.pixels.data() + static_cast<std::size_t>(info.next_scanline) *
                                                                   static_cast<std::size_t>(image.width));
        jpeg_write_scanlines(&info, &row, 1);
    }
    jpeg_finish_compress(&info);
    jpeg_destroy_compress(&info);
    std::string result(reinterpret_cast<char *>(bytes), len);
    std::free(bytes);
    return result;
}

TEST(HostPgm, ReadsCommentsAndBothDepths)
{
    const GrayImage eight = decode("P5 # a comment\n# another\n3\t2\n255\nabcdef");
    EXPECT_EQ(eight.width, 3);
    EXPECT_EQ(eight.height, 2);
    EXPECT_EQ(std::string(eight.pixels.begin(), eight.pixels.end()), "abcdef");
    const GrayImage sixteen = decode(std::string("P5\n2 1\n65535\n\xff\xff\x80\x00", 17));
    EXPECT_EQ(sixteen.pixels, (std::vector<std::uint8_t>{255, 128}));
    const GrayImage small_range = decode(std::string("P5\n3 1\n4\n\x00\x02\x04", 12));
    EXPECT_EQ(small_range.pixels, (std::vector<std::uint8_t>{0, 128, 255})); /* (255 v + 2) / 4 */
}

TEST(HostPgm, RefusesHeadersThatLie)
{
    EXPECT_REFUSED(decode(""), "magic");
    EXPECT_REFUSED(decode("P2 1 1 255 0"), "magic: not a binary PGM");
    EXPECT_REFUSED(decode("P5"), "width: the file ends");
    EXPECT_REFUSED(decode("P5 0 1 255 "), "width: '0'");
    EXPECT_REFUSED(decode("P5 -3 1 255 "), "width: '-3'");
    EXPECT_REFUSED(decode("P5 70000 1 255 "), "width: '70000'");
    EXPECT_REFUSED(decode("P5 4294967297 1 255 "), "width");
    EXPECT_REFUSED(decode("P5 65535 65535 255 "), "size: 65535x65535");
    EXPECT_REFUSED(decode("P5 2 2 70000 abcd"), "maximum");
    EXPECT_REFUSED(decode("P5 2 2 255"), "header");
    EXPECT_REFUSED(decode("P5 2 2 255 abc"), "pixels: 3 bytes, the header promises 4");
    EXPECT_REFUSED(decode("P5 2 2 255 abcde"), "pixels: 5 bytes");
    EXPECT_REFUSED(decode("P5 2 2 256 abcdefg"), "pixels: 7 bytes, the header promises 8");
    EXPECT_REFUSED(decode("P5 1 1 50 a"), "above the maximum 50");
    EXPECT_REFUSED(decode("P5 " + std::string(1000, '1') + " 1 255 a"), "more than 32 characters");
}

TEST(HostPgm, RoundTrip)
{
    const Folder folder;
    const GrayImage image = ramp(13, 5);
    write_pgm(folder / "a.pgm", image.view());
    EXPECT_EQ(read_gray_image(folder / "a.pgm").pixels, image.pixels);
    EXPECT_EQ(read_image_size(folder / "a.pgm"), image.size());
}

TEST(HostPng, RoundTripGrayWideAndColour)
{
    const Folder folder;
    const GrayImage image = ramp(17, 9);
    write_png(folder / "gray.png", image.view());
    EXPECT_EQ(read_gray_image(folder / "gray.png").pixels, image.pixels);
    EXPECT_EQ(read_gray16_image(folder / "gray.png").max_value, 255);

    const GrayImage16 wide{2, 2, 65535, {0, 1, 32768, 65535}};
    write_png(folder / "wide.png", wide);
    EXPECT_EQ(read_gray16_image(folder / "wide.png").pixels, wide.pixels);
    EXPECT_EQ(read_gray_image(folder / "wide.png").pixels, (std::vector<std::uint8_t>{0, 0, 128, 255}));

    const RgbImage colour{4, 1, {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}};
    write_png(folder / "colour.png", colour);
    /* (77 R + 150 G + 29 B + 128) / 256 */
    EXPECT_EQ(read_gray_image(folder / "colour.png").pixels, (std::vector<std::uint8_t>{77, 149, 29, 255}));
    EXPECT_REFUSED(read_gray16_image(folder / "colour.png"), "colour: raw values need a gray PNG");
    EXPECT_EQ(read_image_size(folder / "colour.png"), (ImageSize{4, 1}));
}

TEST(HostPng, RowsWithStrideAreWrittenWithout)
{
    const Folder folder;
    const GrayImage image = ramp(10, 4);
    tsr_gray_view view = image.view();
    view.width = 6;
    write_png(folder / "a.png", view);
    const GrayImage read = read_gray_image(folder / "a.png");
    EXPECT_EQ(read.size(), (ImageSize{6, 4}));
    EXPECT_EQ(read.pixels[6], image.pixels[10]);
}

TEST(HostPng, EveryTruncationIsRefused)
{
    const Folder folder;
    write_png(folder / "a.png", ramp(20, 20).view());
    const std::string whole = read_all(folder / "a.png");
    for (std::size_t len = 0; len < whole.size(); len++) {
        EXPECT_THROW(decode(whole.substr(0, len)), InputError) << len;
    }
}

TEST(HostPng, EveryChangedByteIsSafe)
{
    const Folder folder;
    write_png(folder / "a.png", ramp(20, 20).view());
    const std::string whole = read_all(folder / "a.png");
    for (std::size_t i = 0; i < whole.size(); i++) {
        for (const int flip : {0x01, 0x80, 0xff}) {
            std::string damaged = whole;
            damaged[i] = static_cast<char>(damaged[i] ^ flip);
            try {
                decode(damaged);
            } catch (const InputError &) {
            }
        }
    }
}

TEST(HostJpeg, ReadsAndRefusesTruncations)
{
    GrayImage image{32, 16, std::vector<std::uint8_t>(512, 100)};
    const std::string whole = jpeg_of(image);
    const GrayImage read = decode(whole);
    EXPECT_EQ(read.size(), image.size());
    EXPECT_NEAR(read.pixels[100], 100, 2);
    for (std::size_t len = 0; len < whole.size(); len++) {
        EXPECT_THROW(decode(whole.substr(0, len)), InputError) << len;
    }
}

TEST(HostJpeg, EveryChangedByteIsSafe)
{
    const std::string whole = jpeg_of(ramp(24, 24));
    for (std::size_t i = 0; i < whole.size(); i++) {
        for (const int flip : {0x01, 0x80, 0xff}) {
            std::string damaged = whole;
            damaged[i] = static_cast<char>(damaged[i] ^ flip);
            try {
                decode(damaged);
            } catch (const InputError &) {
            }
        }
    }
}

TEST(HostImageFile, NamesTheFileThatCannotBeReadOrWritten)
{
    const Folder folder;
    EXPECT_REFUSED(read_gray_image(folder / "absent.png"), "absent.png: No such file");
    EXPECT_REFUSED(read_gray_image(folder.path()), "not a regular file");
    EXPECT_REFUSED(write_pgm(folder / "no/such/folder.pgm", ramp(2, 2).view()), "folder.pgm: create");
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    EXPECT_REFUSED(read_gray_image(folder / "pipe"), "not a regular file");
}

TEST(HostImageFile, AFailedWriteLeavesNothingBehind)
{
    const Folder folder;
    std::filesystem::create_directory(folder / "a.pgm"); /* rename(2) onto a folder fails */
    EXPECT_REFUSED(write_pgm(folder / "a.pgm", ramp(2, 2).view()), "a.pgm: rename");
    std::size_t entries = 0;
    for (const auto &entry : std::filesystem::directory_iterator(folder.path())) {
        entries += entry.exists() ? 1 : 0;
    }
    EXPECT_EQ(entries, 1u);
}

} // namespace
} // namespace tsr

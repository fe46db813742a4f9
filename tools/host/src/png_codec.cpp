/*
 * PNG by libpng. An error inside libpng jumps to the setjmp() of the step
 * that called it; those steps hold no object with a destructor, so nothing
 * is skipped.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "image_codecs.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>
#include <string>

#include <png.h>

#include "tsr/host/input_error.h"

namespace tsr
{
namespace
{

/* One deflate byte expands to at most 1032 (zlib's technical notes): a header
 * that promises more lies, and is refused before memory is taken. */
constexpr std::uint64_t kDeflateRatioMax = 1032;

struct Fault {
    std::array<char, 128> message{};
};

void remember_and_jump(png_structp png, png_const_charp message)
{
    auto *fault = static_cast<Fault *>(png_get_error_ptr(png));
    std::strncpy(fault->message.data(), message, fault->message.size() - 1);
    png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

struct Source {
    const std::uint8_t *at;
    std::size_t left;
};

void read_source(png_structp png, png_bytep out, std::size_t len)
{
    auto *source = static_cast<Source *>(png_get_io_ptr(png));
    if (len > source->left) {
        png_error(png, "the file ends inside the image");
    }
    std::memcpy(out, source->at, len);
    source->at += len;
    source->left -= len;
}

class Reader
{
  public:
    Reader(std::span<const std::uint8_t> bytes, std::filesystem::path name)
        : source_{bytes.data(), bytes.size()}, file_len_(bytes.size()), name_(std::move(name))
    {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &fault_, remember_and_jump, ignore_warning);
        info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
        if (info_ == nullptr) {
            png_destroy_read_struct(&png_, nullptr, nullptr);
            throw std::bad_alloc();
        }
    }
    Reader(const Reader &) = delete;
    Reader &operator=(const Reader &) = delete;
    ~Reader() { png_destroy_read_struct(&png_, &info_, nullptr); }

    ImageSize header()
    {
        if (!read_info()) {
            refuse();
        }
        return checked_size(png_get_image_width(png_, info_), png_get_image_height(png_, info_), name_);
    }

    PngPixels pixels()
    {
        PngPixels image;
        image.size = header();
        if (!start_rows()) {
            refuse();
        }
        image.channels = png_get_channels(png_, info_);
        image.depth = png_get_bit_depth(png_, info_);
        const std::size_t row_len = png_get_rowbytes(png_, info_);
        const std::uint64_t len = std::uint64_t{row_len} * static_cast<unsigned>(image.size.height);
        if (len > (file_len_ + 64) * kDeflateRatioMax * 8) { /* 8: samples below 8 bits are widened */
            throw InputError(name_.string(), "pixels", "the file is too short for its header's size");
        }
        image.bytes.resize(len);
        std::vector<png_bytep> rows(static_cast<std::size_t>(image.size.height));
        for (std::size_t y = 0; y < rows.size(); y++) {
            rows[y] = image.bytes.data() + y * row_len;
        }
        if (!read_rows(rows.data())) {
            refuse();
        }
        return image;
    }

  private:
    bool read_info()
    {
        if (setjmp(png_jmpbuf(png_)) != 0) {
            return false;
        }
        png_set_read_fn(png_, &source_, read_source);
        png_set_user_limits(png_, kImageSideMax, kImageSideMax);
        png_read_info(png_, info_);
        return true;
    }

    /* Every kind of PNG becomes gray or RGB of 8 or 16 bits. */
    bool start_rows()
    {
        if (setjmp(png_jmpbuf(png_)) != 0) {
            return false;
        }
        const int type = png_get_color_type(png_, info_);
        if (type == PNG_COLOR_TYPE_PALETTE) {
            png_set_palette_to_rgb(png_);
        }
        if (type == PNG_COLOR_TYPE_GRAY && png_get_bit_depth(png_, info_) < 8) {
            png_set_expand_gray_1_2_4_to_8(png_);
        }
        png_set_strip_alpha(png_);
        png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        return true;
    }

    bool read_rows(png_bytepp rows)
    {
        if (setjmp(png_jmpbuf(png_)) != 0) {
            return false;
        }
        png_read_image(png_, rows);
        png_read_end(png_, nullptr);
        return true;
    }

    [[noreturn]] void refuse() const { throw InputError(name_.string(), "PNG", fault_.message.data()); }

    Source source_;
    std::size_t file_len_;
    std::filesystem::path name_;
    Fault fault_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
};

void append_bytes(png_structp png, png_bytep bytes, std::size_t len)
{
    auto *out = static_cast<std::vector<std::uint8_t> *>(png_get_io_ptr(png));
    out->insert(out->end(), bytes, bytes + len);
}

void keep_buffered(png_structp) {}

bool write_rows(png_structp png, png_infop info, const PngPixels &image, std::vector<std::uint8_t> *out)
{
    if (setjmp(png_jmpbuf(png)) != 0) {
        return false;
    }
    png_set_write_fn(png, out, append_bytes, keep_buffered);
    png_set_IHDR(png, info, static_cast<png_uint_32>(image.size.width), static_cast<png_uint_32>(image.size.height),
                 image.depth, image.channels == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    const std::size_t row_len = image.bytes.size() / static_cast<std::size_t>(image.size.height);
    for (std::size_t y = 0; y < static_cast<std::size_t>(image.size.height); y++) {
        png_write_row(png, image.bytes.data() + y * row_len);
    }
    png_write_end(png, nullptr);
    return true;
}

} // namespace

bool is_png(std::span<const std::uint8_t> bytes)
{
    return bytes.size() >= 8 && png_sig_cmp(bytes.data(), 0, 8) == 0;
}

ImageSize png_size(std::span<const std::uint8_t> bytes, const std::filesystem::path &name)
{
    return Reader(bytes, name).header();
}

PngPixels decode_png(std::span<const std::uint8_t> bytes, const std::filesystem::path &name)
{
    return Reader(bytes, name).pixels();
}

std::vector<std::uint8_t> encode_png(const PngPixels &image)
{
    Fault fault;
    std::vector<std::uint8_t> out;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &fault, remember_and_jump, ignore_warning);
    png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
    const bool written = info != nullptr && write_rows(png, info, image, &out);
    png_destroy_write_struct(&png, &info);
    if (!written) {
        throw std::runtime_error(std::string("libpng: ") + fault.message.data());
    }
    return out;
}

} // namespace tsr

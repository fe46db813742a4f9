/*
 * JPEG by libjpeg; errors jump as in png_codec.cpp. A file that libjpeg would
 * mend with gray pixels (it warns of a premature end) is refused.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "image_codecs.h"

#include <array>
#include <csetjmp>
#include <cstdio>

#include <jpeglib.h>

#include <jerror.h>

#include "tsr/host/input_error.h"

namespace tsr
{
namespace
{

/* A progressive file of a few bytes can ask for this many passes over the
 * whole image; real encoders use about ten. */
constexpr int kScansMax = 100;

struct ErrorManager {
    jpeg_error_mgr base; /* first: libjpeg knows only this part */
    std::jmp_buf jump;
    std::array<char, JMSG_LENGTH_MAX> message;
};

void remember_and_jump(j_common_ptr info)
{
    auto *manager = reinterpret_cast<ErrorManager *>(info->err);
    info->err->format_message(info, manager->message.data());
    std::longjmp(manager->jump, 1);
}

void refuse_damage(j_common_ptr info, int level)
{
    if (level < 0 && info->err->msg_code != JWRN_EXTRANEOUS_DATA) {
        remember_and_jump(info);
    }
}

void stop_endless_scans(j_common_ptr info)
{
    auto *decoder = reinterpret_cast<j_decompress_ptr>(info);
    if (decoder->input_scan_number > kScansMax) {
        auto *manager = reinterpret_cast<ErrorManager *>(info->err);
        std::snprintf(manager->message.data(), manager->message.size(), "more than %d scans", kScansMax);
        std::longjmp(manager->jump, 1);
    }
}

class Reader
{
  public:
    Reader(std::span<const std::uint8_t> bytes, std::filesystem::path name) : bytes_(bytes), name_(std::move(name))
    {
        info_.err = jpeg_std_error(&errors_.base);
        errors_.base.error_exit = remember_and_jump;
        errors_.base.emit_message = refuse_damage;
        progress_.progress_monitor = stop_endless_scans;
        if (!create()) {
            refuse();
        }
    }
    Reader(const Reader &) = delete;
    Reader &operator=(const Reader &) = delete;
    ~Reader() { jpeg_destroy_decompress(&info_); }

    ImageSize header()
    {
        if (!read_header()) {
            refuse();
        }
        return checked_size(info_.image_width, info_.image_height, name_);
    }

    GrayImage pixels()
    {
        const ImageSize size = header();
        if (!start()) {
            refuse();
        }
        GrayImage image{size.width, size.height, {}};
        image.pixels.resize(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
        if (!read_rows(image.pixels.data())) {
            refuse();
        }
        return image;
    }

  private:
    bool create()
    {
        if (setjmp(errors_.jump) != 0) {
            return false;
        }
        jpeg_create_decompress(&info_);
        info_.progress = &progress_;
        return true;
    }

    bool read_header()
    {
        if (setjmp(errors_.jump) != 0) {
            return false;
        }
        jpeg_mem_src(&info_, bytes_.data(), bytes_.size());
        jpeg_read_header(&info_, TRUE);
        return true;
    }

    bool start()
    {
        if (setjmp(errors_.jump) != 0) {
            return false;
        }
        info_.out_color_space = JCS_GRAYSCALE;
        info_.dct_method = JDCT_ISLOW;
        jpeg_start_decompress(&info_);
        return true;
    }

    bool read_rows(std::uint8_t *pixels)
    {
        if (setjmp(errors_.jump) != 0) {
            return false;
        }
        while (info_.output_scanline < info_.output_height) {
            JSAMPROW row = pixels + static_cast<std::size_t>(info_.output_scanline) * info_.output_width;
            jpeg_read_scanlines(&info_, &row, 1);
        }
        jpeg_finish_decompress(&info_);
        return true;
    }

    [[noreturn]] void refuse() const { throw InputError(name_.string(), "JPEG", errors_.message.data()); }

    std::span<const std::uint8_t> bytes_;
    std::filesystem::path name_;
    ErrorManager errors_{};
    jpeg_progress_mgr progress_{};
    jpeg_decompress_struct info_{};
};

} // namespace

bool is_jpeg(std::span<const std::uint8_t> bytes)
{
    return bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff;
}

ImageSize jpeg_size(std::span<const std::uint8_t> bytes, const std::filesystem::path &name)
{
    return Reader(bytes, name).header();
}

GrayImage decode_jpeg(std::span<const std::uint8_t> bytes, const std::filesystem::path &name)
{
    return Reader(bytes, name).pixels();
}

} // namespace tsr

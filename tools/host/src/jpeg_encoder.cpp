/* JPEG out, by libjpeg; errors jump as in png_codec.cpp. SPDX-License-Identifier: Apache-2.0 */
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include <jpeglib.h>

#include "tsr/host/image_file.h"

namespace tsr
{
namespace
{

struct ErrorManager {
    jpeg_error_mgr base; /* first: libjpeg knows only this part */
    std::jmp_buf jump;
};

void jump_back(j_common_ptr info)
{
    std::longjmp(reinterpret_cast<ErrorManager *>(info->err)->jump, 1);
}

class Writer
{
  public:
    Writer()
    {
        info_.err = jpeg_std_error(&errors_.base);
        errors_.base.error_exit = jump_back;
    }
    Writer(const Writer &) = delete;
    Writer &operator=(const Writer &) = delete;
    ~Writer()
    {
        jpeg_destroy_compress(&info_);
        std::free(bytes_);
    }

    /* False: out of memory, or a side of 0. */
    bool encode(tsr_gray_view image, int quality)
    {
        if (setjmp(errors_.jump) != 0) {
            bytes_ = nullptr; /* libjpeg may have given it back */
            return false;
        }
        jpeg_create_compress(&info_);
        jpeg_mem_dest(&info_, &bytes_, &len_);
        info_.image_width = image.width;
        info_.image_height = image.height;
        info_.input_components = 1;
        info_.in_color_space = JCS_GRAYSCALE;
        jpeg_set_defaults(&info_);
        info_.dct_method = JDCT_ISLOW;
        jpeg_set_quality(&info_, quality, TRUE);
        jpeg_start_compress(&info_, TRUE);
        while (info_.next_scanline < info_.image_height) {
            auto *row = const_cast<JSAMPROW>(image.pixels + std::size_t{info_.next_scanline} * image.stride);
            jpeg_write_scanlines(&info_, &row, 1);
        }
        jpeg_finish_compress(&info_);
        return true;
    }
    std::vector<std::uint8_t> bytes() const { return {bytes_, bytes_ + len_}; }

  private:
    ErrorManager errors_{};
    jpeg_compress_struct info_{};
    unsigned char *bytes_ = nullptr;
    unsigned long len_ = 0;
};

} // namespace

std::vector<std::uint8_t> encode_jpeg(tsr_gray_view image, int quality)
{
    Writer writer;
    if (!writer.encode(image, quality)) {
        throw std::runtime_error("encode_jpeg: libjpeg refuses the picture");
    }
    return writer.bytes();
}

} // namespace tsr

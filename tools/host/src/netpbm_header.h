/*
 * The text header that PGM and PFM share: a two-letter magic, then tokens
 * between white space, with '#' comments up to the end of the line.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_NETPBM_HEADER_H
#define TSR_HOST_NETPBM_HEADER_H

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace tsr
{

class NetpbmHeader
{
  public:
    /* Starts behind the magic. */
    NetpbmHeader(std::span<const std::uint8_t> bytes, std::filesystem::path name)
        : bytes_(bytes), name_(std::move(name))
    {
    }

    /* The next token; at most 32 characters, otherwise InputError naming field. */
    std::string token(const char *field);
    /* The next token as a decimal number of minimum..maximum. */
    std::uint32_t number(const char *field, std::uint32_t minimum, std::uint32_t maximum);
    /* The bytes behind the single white space that ends the header. */
    std::span<const std::uint8_t> data();
    [[noreturn]] void refuse(const char *field, const std::string &reason) const;

  private:
    bool at_space() const;
    void skip_space();

    std::span<const std::uint8_t> bytes_;
    std::filesystem::path name_;
    std::size_t at_ = 2;
};

} // namespace tsr

#endif

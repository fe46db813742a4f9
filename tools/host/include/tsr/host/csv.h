/*
 * Fields of CSV files, RFC 4180.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_CSV_H
#define TSR_HOST_CSV_H

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace tsr
{

/* text as a field: in quotation marks if it has a comma, a quotation mark or a line's end. */
std::string csv_field(std::string_view text);

/* The text of a field that stands alone, without its quotation marks; nothing if they are not in pairs. A field that
 * does not begin with one is what it is, commas and marks included. */
std::optional<std::string> csv_text(std::string_view field);

inline constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

/* Lines of a file, in memory as a whole: without their ends (LF or CRLF), without a byte order mark in front; empty
 * ones are passed over. */
class CsvLines
{
  public:
    /* Throws InputError if it cannot be read or is larger than max_len bytes. */
    CsvLines(const std::filesystem::path &file, std::size_t max_len);

    /* Valid as long as this is. Nothing: that was the last. */
    std::optional<std::string_view> next();
    /* Of the line that next() gave: "file:number". */
    std::string place() const;

  private:
    std::string file_;
    std::string text_;
    std::size_t at_ = 0;
    std::size_t number_ = 0;
};

} // namespace tsr

#endif

/* Fields of CSV files. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/csv.h"

#include <algorithm>

#include "tsr/host/read_file.h"

namespace tsr
{

std::string csv_field(std::string_view text)
{
    if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
        return std::string(text);
    }
    std::string field = "\"";
    for (const char c : text) {
        field += c;
        if (c == '"') {
            field += c;
        }
    }
    return field + "\"";
}

std::optional<std::string> csv_text(std::string_view field)
{
    if (!field.starts_with('"')) {
        return std::string(field);
    }
    std::string text;
    std::size_t at = 1;
    for (; at < field.size() && (field[at] != '"' || field.substr(at, 2) == "\"\""); ++at) {
        text += field[at];
        at += field[at] == '"' ? 1 : 0;
    }
    return at + 1 == field.size() ? std::optional(text) : std::nullopt;
}

CsvLines::CsvLines(const std::filesystem::path &file, std::size_t max_len)
    : file_(file.string()), text_(read_text_file(file, max_len))
{
    at_ = text_.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
}

std::optional<std::string_view> CsvLines::next()
{
    while (at_ < text_.size()) {
        const std::size_t end = std::min(text_.find('\n', at_), text_.size());
        std::string_view line = std::string_view(text_).substr(at_, end - at_);
        at_ = end + 1;
        ++number_;
        if (line.ends_with('\r')) {
            line.remove_suffix(1);
        }
        if (!line.empty()) {
            return line;
        }
    }
    return std::nullopt;
}

std::string CsvLines::place() const
{
    return file_ + ":" + std::to_string(number_);
}

} // namespace tsr

/* A scenario with its settings, as TOML. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/scenario/effective.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>

#include "tsr/host/toml_fields.h"

namespace tsr
{

namespace
{

namespace fs = std::filesystem;

/* The one path that a scenario has. */
template <typename Table> auto recorded_site(Table &table)
{
    return table.at_path("recorded.site").as_string();
}

/* As it is if there is no shorter one that is a fraction still. */
std::string shortest(const std::string &number)
{
    double value = 0;
    std::from_chars(number.data(), number.data() + number.size(), value);
    std::array<char, 32> shown{};
    const auto end = std::to_chars(shown.data(), shown.data() + shown.size(), value);
    const std::string shorter(shown.data(), end.ptr);
    return shorter.size() < number.size() && shorter.find_first_of(".e") != std::string::npos ? shorter : number;
}

/* As long as toml++ prints them that are not round. */
bool has_long_fraction(const std::string &word)
{
    constexpr std::size_t kLong = 14;
    const std::size_t point = word.find('.');
    return point != std::string::npos &&
           std::min(word.find_first_not_of("0123456789", point + 1), word.size()) > point + kLong;
}

std::string with_short_numbers_in(const std::string &line)
{
    constexpr const char *kOfNumbers = "0123456789.e+-";
    std::string result;
    for (std::size_t at = 0; at < line.size();) {
        const std::size_t end = std::min(line.find_first_not_of(kOfNumbers, at), line.size());
        const std::size_t next = std::min(line.find_first_of(kOfNumbers, end), line.size());
        const std::string word = line.substr(at, end - at);
        result += (has_long_fraction(word) ? shortest(word) : word) + line.substr(end, next - end);
        at = next;
    }
    return result;
}

/* toml++ of distributions prints 0.3 as 0.29999999999999999: the shortest text of the same number takes its place.
 * Lines with strings stay as they are, and so does a text with strings of several lines. */
std::string with_short_numbers(const std::string &text)
{
    if (text.find("\"\"\"") != std::string::npos || text.find("'''") != std::string::npos) {
        return text;
    }
    std::istringstream lines(text);
    std::string result;
    for (std::string line; std::getline(lines, line);) {
        const bool has_strings = line.find_first_of("\"'") != std::string::npos;
        result += (has_strings ? line : with_short_numbers_in(line)) + '\n';
    }
    return result;
}

} // namespace

EffectiveScenario::EffectiveScenario(const fs::path &file, const std::vector<std::string> &settings)
    : file_(file), table_(TomlFile(file, settings).table())
{
}

std::string EffectiveScenario::text_for(const fs::path &folder) const
{
    toml::table table = table_;
    if (auto *site = recorded_site(table); site != nullptr && fs::path(site->get()).is_relative()) {
        *site = fs::relative(fs::absolute(file_).parent_path() / site->get(), folder).generic_string();
    }
    std::ostringstream text;
    text << table;
    return with_short_numbers(text.str());
}

std::string without_folders(const std::string &setting)
{
    toml::table table = toml::parse(setting);
    auto *site = recorded_site(table);
    if (site == nullptr || fs::path(site->get()).is_relative()) {
        return setting;
    }
    std::ostringstream text;
    text << "recorded.site = " << toml::value<std::string>(fs::path(site->get()).filename().string());
    return text.str();
}

} // namespace tsr

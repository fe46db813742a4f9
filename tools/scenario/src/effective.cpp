/* A scenario with its settings, as TOML. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/scenario/effective.h"

#include <array>
#include <charconv>
#include <regex>
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

std::string with_short_numbers_in(const std::string &line)
{
    static const std::regex kLong("[0-9]+\\.[0-9]{14,}(e[-+]?[0-9]+)?");
    std::string result;
    auto rest = line.cbegin();
    for (std::sregex_iterator found(line.begin(), line.end(), kLong), none; found != none; ++found) {
        result.append(rest, (*found)[0].first);
        result += shortest(found->str());
        rest = (*found)[0].second;
    }
    return result.append(rest, line.cend());
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

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

/* toml++ of distributions prints 0.3 as 0.29999999999999999: the shortest text of the same number takes its place.
 * Lines with strings stay as they are. */
std::string with_short_numbers(const std::string &text)
{
    static const std::regex kLong("[0-9]+\\.[0-9]{14,}(e[-+]?[0-9]+)?");
    std::istringstream lines(text);
    std::string result;
    for (std::string line; std::getline(lines, line);) {
        std::smatch found;
        while (line.find_first_of("\"'") == std::string::npos && std::regex_search(line, found, kLong)) {
            const std::string number = found.str();
            double value = 0;
            std::from_chars(number.data(), number.data() + number.size(), value);
            std::array<char, 32> shown{};
            const auto end = std::to_chars(shown.data(), shown.data() + shown.size(), value);
            const std::string shorter(shown.data(), end.ptr);
            if (shorter.size() >= number.size() || shorter.find_first_of(".e") == std::string::npos) {
                break;
            }
            line.replace(static_cast<std::size_t>(found.position()), number.size(), shorter);
        }
        result += line + '\n';
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
    const auto *site = recorded_site(table);
    const std::string folder =
        site != nullptr && fs::path(site->get()).is_absolute() ? fs::path(site->get()).parent_path().string() : "";
    const std::size_t at = folder.empty() ? std::string::npos : setting.find(folder);
    return at == std::string::npos ? setting : std::string(setting).erase(at, folder.size() + 1);
}

} // namespace tsr

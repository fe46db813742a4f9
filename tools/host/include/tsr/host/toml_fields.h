/*
 * Typed access to TOML tables in which every field is either asked for or
 * refused as unknown. Errors are InputErrors "file:line: table: field: reason".
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_TOML_FIELDS_H
#define TSR_HOST_TOML_FIELDS_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "tsr/host/input_error.h"

namespace tsr
{

class TomlFields
{
  public:
    /* table is borrowed from a TomlFile; prefix stands before each field in errors ("node 3", "right"). */
    TomlFields(const toml::table &table, std::string file, std::string prefix);

    /* A name for errors that is known only after a first look at the fields. */
    void set_prefix(std::string prefix) { prefix_ = std::move(prefix); }
    int line() const { return static_cast<int>(table_->source().begin.line); }
    bool has(std::string_view field) const { return table_->contains(field); }

    /* Without a fallback the field is required. Ranges are inclusive. */
    std::string string(std::string_view field, std::optional<std::string> fallback = {});
    bool boolean(std::string_view field, bool fallback);
    std::int64_t integer(std::string_view field, std::int64_t minimum, std::int64_t maximum,
                         std::optional<std::int64_t> fallback = {});
    double number(std::string_view field, double minimum, double maximum, std::optional<double> fallback = {});
    void numbers(std::string_view field, double *values, std::size_t count, bool required);
    template <std::size_t N> std::array<double, N> numbers(std::string_view field)
    {
        std::array<double, N> values{};
        numbers(field, values.data(), N, true);
        return values;
    }

    /* A list of lists of N whole numbers each, [[1, 2], [3, 4]]; empty if absent. */
    template <std::size_t N> std::vector<std::array<int, N>> lists(std::string_view field, int minimum, int maximum)
    {
        std::vector<std::array<int, N>> values(count_lists(field));
        for (std::size_t i = 0; i < values.size(); i++) {
            list(field, i, values[i].data(), N, minimum, maximum);
        }
        return values;
    }

    /* A sub-table; null if absent. */
    std::unique_ptr<TomlFields> table(std::string_view field);
    /* An array of tables, empty if absent. */
    std::vector<TomlFields> tables(std::string_view field);

    /* Call last: refuses the first field nobody asked for. */
    void refuse_unknown() const;
    [[noreturn]] void refuse(std::string_view field, const std::string &reason) const;

  private:
    const toml::node *find(std::string_view field);
    std::size_t count_lists(std::string_view field);
    void list(std::string_view field, std::size_t index, int *values, std::size_t count, int minimum, int maximum);
    const toml::node &required(std::string_view field);
    std::string path(std::string_view field) const;

    const toml::table *table_;
    std::string file_;
    std::string prefix_;
    std::set<std::string, std::less<>> asked_;
};

class TomlFile
{
  public:
    /* Reads and parses; throws InputError with the line of a syntax error. */
    explicit TomlFile(const std::filesystem::path &file);
    /* Then each setting, "table.field = value" as TOML has it, in the place of what the file says. */
    TomlFile(const std::filesystem::path &file, const std::vector<std::string> &settings);
    TomlFields top() const { return {table_, file_, ""}; }
    /* Everything, settings included. */
    const toml::table &table() const { return table_; }

  private:
    std::string file_;
    toml::table table_;
};

} // namespace tsr

#endif

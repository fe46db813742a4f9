/* Typed access to TOML tables. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/toml_fields.h"

#include <charconv>
#include <cmath>

#include "tsr/host/read_file.h"

namespace tsr
{
namespace
{

constexpr std::size_t kTomlLenMax = std::size_t{16} << 20;

/* The parser recurses into brackets and dotted keys, and a hostile file must not exhaust the stack: toml++ limits the
 * brackets (TOML_MAX_NESTED_VALUES, 256), the length of a line limits the dots. */
constexpr std::size_t kLineLenMax = 4096;

void check_lines(const std::string &file, const std::string &text)
{
    std::size_t number = 1;
    std::size_t start = 0;
    for (std::size_t end = 0; end <= text.size(); end++) {
        if (end < text.size() && text[end] != '\n') {
            continue;
        }
        if (end - start > kLineLenMax) {
            throw InputError(file + ":" + std::to_string(number), "TOML",
                             "the line is longer than " + std::to_string(kLineLenMax) + " bytes");
        }
        start = end + 1;
        number++;
    }
}

toml::table parse(const std::string &file, const std::string &text)
{
    check_lines(file, text);
    try {
        return toml::parse(text, std::string_view(file));
    } catch (const toml::parse_error &error) {
        throw InputError(file + ":" + std::to_string(error.source().begin.line), "TOML",
                         std::string(error.description()));
    }
}

std::string shown(double value)
{
    std::array<char, 32> text{};
    const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
    return {text.data(), result.ptr};
}

/* Tables are joined, everything else is replaced. Values are moved: toml++ forgets where a copied one stood. */
void overwrite(toml::table &table, toml::table &&by)
{
    for (auto &&entry : by) {
        toml::node &value = entry.second;
        toml::table *inner = table[entry.first].as_table();
        if (inner != nullptr && value.is_table()) {
            overwrite(*inner, std::move(*value.as_table()));
        } else {
            value.visit([&](auto &concrete) { table.insert_or_assign(entry.first, std::move(concrete)); });
        }
    }
}

} // namespace

TomlFields::TomlFields(const toml::table &table, std::string file, std::string prefix)
    : table_(&table), file_(std::move(file)), prefix_(std::move(prefix))
{
}

std::string TomlFields::path(std::string_view field) const
{
    if (prefix_.empty()) {
        return std::string(field);
    }
    return prefix_ + (prefix_.back() == '.' ? "" : ": ") + std::string(field);
}

void TomlFields::refuse(std::string_view field, const std::string &reason) const
{
    const toml::node *node = table_->get(field);
    const toml::source_region &source = node != nullptr ? node->source() : table_->source();
    const bool is_setting = source.path && *source.path != file_;
    const std::string place = is_setting ? *source.path : file_ + ":" + std::to_string(source.begin.line);
    throw InputError(source.begin.line > 0 ? place : file_, path(field), reason);
}

const toml::node *TomlFields::find(std::string_view field)
{
    asked_.emplace(field);
    return table_->get(field);
}

const toml::node &TomlFields::required(std::string_view field)
{
    const toml::node *node = find(field);
    if (node == nullptr) {
        refuse(field, "is missing");
    }
    return *node;
}

std::string TomlFields::string(std::string_view field, std::optional<std::string> fallback)
{
    if (fallback && find(field) == nullptr) {
        return *fallback;
    }
    const auto *value = required(field).as_string();
    if (value == nullptr) {
        refuse(field, "is not a string");
    }
    if (value->get().find('\0') != std::string::npos) {
        refuse(field, "holds a NUL, where a name of a file would end");
    }
    return value->get();
}

bool TomlFields::boolean(std::string_view field, bool fallback)
{
    const toml::node *node = find(field);
    if (node == nullptr) {
        return fallback;
    }
    const auto *value = node->as_boolean();
    if (value == nullptr) {
        refuse(field, "is not true or false");
    }
    return value->get();
}

std::int64_t TomlFields::integer(std::string_view field, std::int64_t minimum, std::int64_t maximum,
                                 std::optional<std::int64_t> fallback)
{
    if (fallback && find(field) == nullptr) {
        return *fallback;
    }
    const auto *value = required(field).as_integer();
    if (value == nullptr) {
        refuse(field, "is not a whole number");
    }
    if (value->get() < minimum || value->get() > maximum) {
        refuse(field, std::to_string(value->get()) + " is outside " + std::to_string(minimum) + ".." +
                          std::to_string(maximum));
    }
    return value->get();
}

double TomlFields::number(std::string_view field, double minimum, double maximum, std::optional<double> fallback)
{
    if (fallback && find(field) == nullptr) {
        return *fallback;
    }
    const auto value = required(field).value<double>();
    if (!value || required(field).is_boolean()) {
        refuse(field, "is not a number");
    }
    if (!(*value >= minimum && *value <= maximum)) {
        refuse(field, shown(*value) + " is outside " + shown(minimum) + ".." + shown(maximum));
    }
    return *value;
}

void TomlFields::numbers(std::string_view field, double *values, std::size_t count, bool required_field)
{
    if (!required_field && find(field) == nullptr) {
        return;
    }
    const auto *array = required(field).as_array();
    if (array == nullptr || array->size() != count) {
        refuse(field, "is not a list of " + std::to_string(count) + " numbers");
    }
    for (std::size_t i = 0; i < count; i++) {
        const auto value = array->get(i)->is_number() ? array->get(i)->value<double>() : std::nullopt;
        if (!value || !std::isfinite(*value)) {
            refuse(field, "element " + std::to_string(i + 1) + " is not a finite number");
        }
        values[i] = *value;
    }
}

std::size_t TomlFields::count_lists(std::string_view field)
{
    const toml::node *node = find(field);
    if (node == nullptr) {
        return 0;
    }
    const toml::array *array = node->as_array();
    if (array == nullptr || !(array->empty() || array->is_homogeneous(toml::node_type::array))) {
        refuse(field, "is not a list of lists");
    }
    return array->size();
}

void TomlFields::list(std::string_view field, std::size_t index, int *values, std::size_t count, int minimum,
                      int maximum)
{
    const toml::array &inner = *required(field).as_array()->get(index)->as_array();
    const std::string which = "element " + std::to_string(index + 1);
    if (inner.size() != count) {
        refuse(field, which + " is not a list of " + std::to_string(count) + " whole numbers");
    }
    for (std::size_t i = 0; i < count; i++) {
        const auto *value = inner.get(i)->as_integer();
        if (value == nullptr || value->get() < minimum || value->get() > maximum) {
            refuse(field, which + ": number " + std::to_string(i + 1) + " is not a whole number in " +
                              std::to_string(minimum) + ".." + std::to_string(maximum));
        }
        values[i] = static_cast<int>(value->get());
    }
}

std::unique_ptr<TomlFields> TomlFields::table(std::string_view field)
{
    const toml::node *node = find(field);
    if (node == nullptr) {
        return nullptr;
    }
    const toml::table *value = node->as_table();
    if (value == nullptr) {
        refuse(field, "is not a table");
    }
    return std::make_unique<TomlFields>(*value, file_, path(field) + ".");
}

std::vector<TomlFields> TomlFields::tables(std::string_view field)
{
    std::vector<TomlFields> result;
    const toml::node *node = find(field);
    if (node == nullptr) {
        return result;
    }
    const toml::array *array = node->as_array();
    if (array == nullptr || !(array->empty() || array->is_homogeneous(toml::node_type::table))) {
        refuse(field, "is not a list of tables, [[" + std::string(field) + "]]");
    }
    for (std::size_t i = 0; i < array->size(); i++) {
        result.emplace_back(*array->get(i)->as_table(), file_, std::string(field) + " " + std::to_string(i + 1));
    }
    return result;
}

void TomlFields::refuse_unknown() const
{
    for (const auto &[key, value] : *table_) {
        if (!asked_.contains(key.str())) {
            refuse(key.str(), "unknown field");
        }
    }
}

TomlFile::TomlFile(const std::filesystem::path &file)
    : file_(file.string()), table_(parse(file_, read_text_file(file, kTomlLenMax)))
{
}

TomlFile::TomlFile(const std::filesystem::path &file, const std::vector<std::string> &settings) : TomlFile(file)
{
    for (const std::string &setting : settings) {
        const std::string place = "--set '" + setting + "'";
        toml::table table = parse(place, setting);
        if (table.empty()) {
            throw InputError(place, "", "is not TABLE.FIELD=VALUE");
        }
        overwrite(table_, std::move(table));
    }
}

} // namespace tsr

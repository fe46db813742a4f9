/*
 * Values of --sweep and their combinations.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/emulator/sweep.h"

#include <algorithm>
#include <cmath>

#include <toml++/toml.h>

#include "tsr/host/input_error.h"

namespace tsr
{

namespace
{

using Json = nlohmann::ordered_json;

/* What a JSON value is written as is TOML for the same value. Null: a kind that JSON does not have, or no finite
 * number. */
Json json_of_toml(const toml::node &node)
{
    if (const auto *integer = node.as_integer()) {
        return integer->get();
    }
    if (const auto *number = node.as_floating_point()) {
        return std::isfinite(number->get()) ? Json(number->get()) : Json();
    }
    if (const auto *text = node.as_string()) {
        return text->get();
    }
    if (const auto *boolean = node.as_boolean()) {
        return boolean->get();
    }
    Json list;
    if (const auto *array = node.as_array()) {
        list = Json::array();
        for (const toml::node &element : *array) {
            list.push_back(json_of_toml(element));
            if (list.back().is_null()) {
                return {};
            }
        }
    }
    return list;
}

bool is_bare_key(const std::string &key)
{
    const auto is_part = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    };
    char before = '.';
    for (const char c : key) {
        if (!is_part(c) && (c != '.' || before == '.')) {
            return false;
        }
        before = c;
    }
    return before != '.';
}

/* The list as toml++ understands it. A bracket and a line's end in the text could begin another key. */
toml::table parse_list(const std::string &place, const std::string &list)
{
    try {
        toml::table table = toml::parse("list = [" + list + "\n]");
        if (table.size() != 1) {
            throw InputError(place, "", "is more than a list of values");
        }
        return table;
    } catch (const toml::parse_error &error) {
        throw InputError(place, "TOML", std::string(error.description()) + "; strings stand in quotation marks");
    }
}

void add_fields(const toml::table &table, const std::string &prefix, std::vector<std::string> &fields)
{
    for (const auto &[key, value] : table) {
        const std::string field = prefix + std::string(key.str());
        if (const toml::table *inner = value.as_table()) {
            add_fields(*inner, field + ".", fields);
        } else {
            fields.push_back(field);
        }
    }
}

/* The key of KEY=..., without the blanks around it. */
std::string key_of(const std::string &setting)
{
    const std::string key = setting.substr(0, setting.find('='));
    const auto first = key.find_first_not_of(" \t");
    return first == std::string::npos ? "" : key.substr(first, key.find_last_not_of(" \t") + 1 - first);
}

} // namespace

std::vector<std::string> fields_of(const std::string &setting)
{
    constexpr std::size_t kSettingMax = 4096; /* longer lines are refused when they are set: dots are parsed in depth */
    std::vector<std::string> fields;
    if (setting.size() > kSettingMax) {
        return fields;
    }
    try {
        add_fields(toml::parse(setting), "", fields);
    } catch (const toml::parse_error &) {
        return {};
    }
    return fields;
}

SweepAxis parse_sweep(const std::string &option)
{
    const std::string place = "--sweep '" + option + "'";
    const std::size_t equals = option.find('=');
    SweepAxis axis{key_of(option), {}};
    if (equals == std::string::npos || !is_bare_key(axis.key)) {
        throw InputError(place, "", "is not TABLE.FIELD=VALUE,VALUE,...");
    }
    const toml::table table = parse_list(place, option.substr(equals + 1));
    for (const toml::node &node : *table.get_as<toml::array>("list")) {
        axis.values.push_back(json_of_toml(node));
        if (axis.values.back().is_null()) {
            throw InputError(place, "value " + std::to_string(axis.values.size()),
                             "is neither a finite number, a string, true, false nor a list of these");
        }
    }
    if (axis.values.empty()) {
        throw InputError(place, "", "has no value");
    }
    return axis;
}

std::vector<SweepPoint> sweep_points(const std::vector<SweepAxis> &axes)
{
    std::vector<SweepPoint> points(1);
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const auto same = [&](const SweepAxis &other) { return other.key == axes[i].key; };
        if (std::any_of(axes.begin(), axes.begin() + static_cast<std::ptrdiff_t>(i), same)) {
            throw InputError("command line", "--sweep", axes[i].key + " is swept twice");
        }
        if (points.size() * axes[i].values.size() > kSweepRunsMax) {
            throw InputError("command line", "--sweep", "makes more than " + std::to_string(kSweepRunsMax) + " runs");
        }
        std::vector<SweepPoint> longer;
        for (const SweepPoint &point : points) {
            for (const Json &value : axes[i].values) {
                longer.push_back(point);
                longer.back().push_back(value);
            }
        }
        points = std::move(longer);
    }
    return points;
}

std::vector<std::string> sweep_settings(const std::vector<SweepAxis> &axes, const SweepPoint &point)
{
    std::vector<std::string> settings;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        settings.push_back(axes[i].key + "=" + point[i].dump());
    }
    return settings;
}

} // namespace tsr

/* Data for pages. SPDX-License-Identifier: Apache-2.0 */
#include "page_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "tsr/host/ply.h"

namespace tsr
{

namespace
{

constexpr std::size_t kPointsMax = 80'000;
constexpr double kGridMax = 65535;
constexpr std::string_view kDataMark = "/*TARSIER-DATA*/null";

using Axis = float CloudPoint::*;
constexpr std::array<Axis, 3> kAxes = {&CloudPoint::x_m, &CloudPoint::y_m, &CloudPoint::z_m};

/* Outliers are many metres away: the grid covers what all but a hundredth of the points need. */
std::array<double, 2> range_of(const std::vector<CloudPoint> &points, Axis axis)
{
    if (points.empty()) {
        return {0, 0};
    }
    std::vector<float> values;
    values.reserve(points.size());
    for (const CloudPoint &point : points) {
        values.push_back(point.*axis);
    }
    std::sort(values.begin(), values.end());
    const std::size_t off = values.size() / 200;
    const double low = values[off];
    const double high = values[values.size() - 1 - off];
    return {low - (high - low) / 2, high + (high - low) / 2};
}

/* A page's numbers are binary64: whole ones that it would change are texts. */
void write_out_large(nlohmann::ordered_json &value)
{
    constexpr std::uint64_t kExactMax = std::uint64_t{1} << 53;
    if (value.is_structured()) {
        for (nlohmann::ordered_json &inner : value) {
            write_out_large(inner);
        }
    } else if (value.is_number_integer() && (value.is_number_unsigned() || value.get<std::int64_t>() > 0) &&
               value.get<std::uint64_t>() > kExactMax) {
        value = value.dump();
    }
}

} // namespace

std::string base64(std::span<const std::uint8_t> bytes)
{
    static constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        unsigned group = 0;
        for (std::size_t j = 0; j < 3; ++j) {
            group = group << 8 | (j < count ? bytes[i + j] : 0u);
        }
        for (std::size_t j = 0; j < 4; ++j) {
            text.push_back(j <= count ? kAlphabet[group >> (18 - 6 * j) & 63u] : '=');
        }
    }
    return text;
}

nlohmann::ordered_json cloud_json(const std::filesystem::path &file)
{
    const auto [of, points] = sample_ply(file, kPointsMax);
    std::array<double, 3> low{};
    std::array<double, 3> step{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto [first, last] = range_of(points, kAxes.at(axis));
        low.at(axis) = first;
        step.at(axis) = std::max((last - first) / kGridMax, 1e-9);
    }
    std::vector<std::uint8_t> positions;
    std::vector<std::uint8_t> colours;
    for (const CloudPoint &point : points) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double place = (static_cast<double>(point.*kAxes.at(axis)) - low.at(axis)) / step.at(axis);
            const auto value = static_cast<std::uint16_t>(std::lround(std::clamp(place, 0.0, kGridMax)));
            positions.push_back(static_cast<std::uint8_t>(value));
            positions.push_back(static_cast<std::uint8_t>(value >> 8));
        }
        colours.insert(colours.end(), {point.red, point.green, point.blue});
    }
    return {{"of", of},     {"count", points.size()},         {"low", low},
            {"step", step}, {"positions", base64(positions)}, {"colours", base64(colours)}};
}

std::string filled_page(std::span<const std::string_view> page, nlohmann::ordered_json data)
{
    std::string filled;
    for (const std::string_view piece : page) {
        filled += piece;
    }
    write_out_large(data);
    /* "<" could end the element that carries the data. */
    constexpr std::string_view kEscaped = "\\u003c";
    std::string text = data.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos; at += kEscaped.size()) {
        text.replace(at, 1, kEscaped);
    }
    return filled.replace(filled.find(kDataMark), kDataMark.size(), text);
}

} // namespace tsr

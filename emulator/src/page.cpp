/*
 * index.html: the page template with the run's data put in.
 *
 * The template (emulator/page/page.html) holds one mark, kDataMark, which
 * becomes a JSON object:
 *
 *   summary   summary.json
 *   timeline  [{t: seconds, node: id, phase: name}, ...]
 *   maps      [{node, t, kept, disparity: PNG data URL, reference: PNG data URL or ""}, ...]
 *   cloud     {count, positions: base64 of count x 3 float32, colours: base64 of count x 3 bytes}
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <algorithm>
#include <cstring>
#include <span>
#include <string_view>

#include "page_template.h"
#include "tsr/emulator/report.h"
#include "tsr/host/atomic_file.h"
#include "tsr/host/input_error.h"
#include "tsr/host/read_file.h"

namespace tsr
{

namespace
{

using Json = nlohmann::ordered_json;

constexpr std::string_view kDataMark = "/*TARSIER-DATA*/null";
constexpr std::size_t kPlyVertexLen = 3 * sizeof(float) + 3; /* tsr/host/ply.h */
constexpr std::size_t kPositionLen = 3 * sizeof(float);

/* RFC 4648, section 4. */
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

std::string png_url(const std::filesystem::path &file)
{
    return std::filesystem::exists(file) ? "data:image/png;base64," + base64(read_file(file)) : std::string();
}

Json maps_json(const std::filesystem::path &out, const std::vector<ReceivedMap> &maps)
{
    Json json = Json::array();
    for (const ReceivedMap &map : maps) {
        json.push_back({{"node", map.node},
                        {"t", static_cast<double>(map.capture_time_us) / 1e6},
                        {"kept", map.kept},
                        {"disparity", png_url(out / (map.file + ".png"))},
                        {"reference", png_url(out / (map.file + "-reference.png"))}});
    }
    return json;
}

/* Positions and colours of the PLY file that the sink wrote. */
Json cloud_json(const std::filesystem::path &file)
{
    const auto bytes = read_file(file);
    const std::string_view text(reinterpret_cast<const char *>(bytes.data()), bytes.size());
    constexpr std::string_view kEnd = "end_header\n";
    const std::size_t header_end = text.find(kEnd);
    if (header_end == std::string_view::npos) {
        throw InputError(file.string(), "header", "has no end");
    }
    const std::span<const std::uint8_t> vertices(bytes.data() + header_end + kEnd.size(),
                                                 bytes.size() - header_end - kEnd.size());
    const std::size_t count = vertices.size() / kPlyVertexLen;
    std::vector<std::uint8_t> positions;
    std::vector<std::uint8_t> colours;
    for (std::size_t i = 0; i < count; ++i) {
        const auto vertex = vertices.subspan(i * kPlyVertexLen, kPlyVertexLen);
        positions.insert(positions.end(), vertex.begin(), vertex.begin() + kPositionLen);
        colours.insert(colours.end(), vertex.begin() + kPositionLen, vertex.end());
    }
    return {{"count", count}, {"positions", base64(positions)}, {"colours", base64(colours)}};
}

Json timeline_json(const Simulation &simulation)
{
    Json json = Json::array();
    for (const PhaseChange &change : simulation.timeline()) {
        json.push_back({{"t", static_cast<double>(change.time_us) / 1e6},
                        {"node", change.node},
                        {"phase", tsr_phase_name(change.phase)}});
    }
    return json;
}

} // namespace

void write_page(const std::filesystem::path &out, const Json &summary, const Simulation &simulation,
                const std::vector<ReceivedMap> &maps)
{
    const Json data{{"summary", summary},
                    {"timeline", timeline_json(simulation)},
                    {"maps", maps_json(out, maps)},
                    {"cloud", cloud_json(out / "cloud.ply")}};
    /* "<" could end the script element that carries the data, or begin another. */
    constexpr std::string_view kEscaped = "\\u003c";
    std::string text = data.dump();
    for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos; at += kEscaped.size()) {
        text.replace(at, 1, kEscaped);
    }
    std::string page = kPageTemplate;
    page.replace(page.find(kDataMark), kDataMark.size(), text);
    write_file_atomically(out / "index.html", page);
}

} // namespace tsr

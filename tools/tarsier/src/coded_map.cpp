/*
 * The map codec, from and to files.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/coding/coded_map.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "tsr/coding/disparity_values.h"
#include "tsr/coding/map_packet_file.h"
#include "tsr/host/input_error.h"
#include "tsr/host/read_file.h"
#include "tsr/stereo/disparity_file.h"

extern "C" {
#include "tsr/codec/map_hold.h"
}

namespace tsr
{
namespace
{

constexpr std::size_t kCodedLenMax =
    TSR_MAP_ENCODED_LEN_MAX(TSR_IMAGE_WIDTH_MAX, TSR_IMAGE_HEIGHT_MAX, TSR_DISPARITY_COUNT_MAX, 0);

unsigned field16(const std::vector<std::uint8_t> &bytes, std::size_t at)
{
    return bytes[at] | static_cast<unsigned>(bytes[at + 1]) << 8U;
}

/* What the codec refuses a header for, in the order of docs/codec.md, 2.1. */
[[noreturn]] void refuse_header(const std::vector<std::uint8_t> &bytes, const std::filesystem::path &file)
{
    const auto refuse = [&](const char *field, const std::string &reason) {
        throw InputError(file.string(), field, reason);
    };
    const auto expect = [&](const char *field, unsigned value, unsigned least, unsigned most) {
        if (value < least || value > most) {
            refuse(field, std::to_string(value) + ", a coded map has " + std::to_string(least) + " .. " +
                              std::to_string(most));
        }
    };
    if (bytes.size() < TSR_MAP_HEADER_LEN) {
        refuse("header",
               std::to_string(bytes.size()) + " bytes, a coded map has at least " + std::to_string(TSR_MAP_HEADER_LEN));
    }
    if (const unsigned version = bytes[0] & 15U; version != TSR_MAP_FORMAT_VERSION) {
        refuse("format version", std::to_string(version) + ", known is " + std::to_string(TSR_MAP_FORMAT_VERSION) +
                                     "; not a coded map, or one of another release");
    }
    expect("mode", bytes[0] >> 4U, 0, 1);
    expect("step", bytes[1] & 7U, 0, TSR_MAP_STEP_LOG2_MAX);
    expect("disparities", bytes[2] + 1U, 1, TSR_DISPARITY_COUNT_MAX);
    expect("width", field16(bytes, 3), 1, TSR_IMAGE_WIDTH_MAX);
    expect("height", field16(bytes, 5), 1, TSR_IMAGE_HEIGHT_MAX);
    if (bytes[0] >> 4U == 1 && bytes.size() < TSR_MAP_HEADER_LEN_MAX) {
        refuse("header", std::to_string(bytes.size()) + " bytes, that of a map coded against another has " +
                             std::to_string(TSR_MAP_HEADER_LEN_MAX));
    }
    throw InputError(file.string(), "prior", std::to_string(bytes[1] >> 4U) + ", which this program does not have");
}

bool is_coded_map(const std::filesystem::path &file)
{
    std::string ending = file.extension().string();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
    return ending == ".tdm";
}

tsr_map_reference reference_of(const HeldMap &held)
{
    return {held.values_q4.data(), held.width, held.id};
}

void expect_ok(tsr_status status)
{
    if (status != TSR_OK) {
        throw std::invalid_argument(std::string("the map codec: ") + tsr_status_name(status));
    }
}

} // namespace

std::uint8_t log2_of_step(double step_px)
{
    return static_cast<std::uint8_t>(std::lround(std::log2(step_px * TSR_DISPARITY_ONE_Q4)));
}

std::vector<std::uint8_t> read_map_file(const std::filesystem::path &file)
{
    std::vector<std::uint8_t> bytes = read_file(file, kMapPacketFileLenMax);
    if (!is_map_packet_file(bytes) && bytes.size() > kCodedLenMax) {
        throw InputError(file.string(), "size",
                         std::to_string(bytes.size()) + " bytes, a coded map has at most " +
                             std::to_string(kCodedLenMax));
    }
    return bytes;
}

CodedMap coded_map_of(std::vector<std::uint8_t> bytes, const std::filesystem::path &file)
{
    CodedMap coded;
    coded.bytes = std::move(bytes);
    if (tsr_map_read_info(coded.bytes.data(), coded.bytes.size(), &coded.info) != TSR_OK) {
        refuse_header(coded.bytes, file);
    }
    return coded;
}

HeldMap read_held_map(const std::filesystem::path &file, std::uint16_t id, std::uint8_t step_log2)
{
    if (is_coded_map(file)) {
        std::vector<std::uint8_t> bytes = read_map_file(file);
        if (is_map_packet_file(bytes)) {
            throw InputError(file.string(), "reference", "is in packets: decode it first, and name the decoded map");
        }
        const CodedMap coded = coded_map_of(std::move(bytes), file);
        if (coded.info.has_reference) {
            throw InputError(file.string(), "reference",
                             "was coded against the map with id " + std::to_string(coded.info.reference_id) +
                                 ": decode it first, and name the decoded map");
        }
        DisparityValues map{coded.info.width, coded.info.height, coded.info.disparities,
                            decode_map(coded, file, std::nullopt)};
        if (coded.info.step_log2 != step_log2) {
            map.values_q4 = quantised(map, step_log2);
        }
        return {id, map.width, map.height, std::move(map.values_q4)};
    }
    const DisparityValues map = disparity_values(read_disparity_file(file), file);
    return {id, map.width, map.height, quantised(map, step_log2)};
}

std::vector<std::uint16_t> decode_map(const CodedMap &coded, const std::filesystem::path &file,
                                      const std::optional<HeldMap> &held)
{
    const tsr_map_info &header = coded.info;
    if (header.has_reference &&
        (!held || held->id != header.reference_id || held->width != header.width || held->height != header.height)) {
        throw InputError(file.string(), "reference", "needs the map with id " + std::to_string(header.reference_id));
    }
    const tsr_map_reference reference = held ? reference_of(*held) : tsr_map_reference{};
    const auto decoder = std::make_unique<tsr_map_decoder>();
    std::vector<std::uint16_t> scratch(TSR_MAP_SCRATCH_COUNT(coded.info.width));
    tsr_map_info info{};
    expect_ok(tsr_map_decode_start(decoder.get(), coded.bytes.data(), coded.bytes.size(), held ? &reference : nullptr,
                                   scratch.data(), scratch.size(), &info));
    std::vector<std::uint16_t> values(std::size_t{info.width} * info.height);
    for (std::size_t row = 0; row < info.height; row++) {
        const tsr_status status = tsr_map_decode_rows(decoder.get(), &values[row * info.width], info.width, 1);
        if (status < 0) {
            throw InputError(file.string(), "labels", "damaged: row " + std::to_string(row) + " has none that exists");
        }
    }
    return values;
}

std::vector<std::uint16_t> held_to(const tsr_map_info &info, const std::vector<std::uint16_t> &values_q4,
                                   std::span<const std::uint16_t> earlier_q4)
{
    const std::size_t pixels = std::size_t{info.width} * info.height;
    if (values_q4.size() != pixels || earlier_q4.size() != pixels) {
        throw std::invalid_argument("maps of another shape than their info's");
    }
    const tsr_map_reference earlier{earlier_q4.data(), info.width, 0};
    std::vector<std::uint16_t> held = values_q4;
    std::vector<std::uint16_t> scratch(TSR_MAP_HOLD_SCRATCH_COUNT(info.width));
    expect_ok(tsr_map_hold(&info, &earlier, held.data(), info.width, scratch.data(), scratch.size(), nullptr));
    for (std::size_t i = 0; i < pixels; i++) {
        const bool can_be_had = held[i] == TSR_DISPARITY_INVALID || held[i] < info.disparities * TSR_DISPARITY_ONE_Q4;
        held[i] = can_be_had ? held[i] : values_q4[i];
    }
    return held;
}

CodedMap encode_map(const tsr_map_info &info, std::span<const std::uint16_t> values_q4,
                    const std::optional<HeldMap> &held)
{
    CodedMap coded;
    coded.bytes.resize(tsr_map_encoded_len_max(&info));
    const std::size_t pixels = std::size_t{info.width} * info.height;
    if (values_q4.size() != pixels || (held && held->values_q4.size() != pixels)) {
        throw std::invalid_argument("a map of another shape");
    }
    const auto encoder = std::make_unique<tsr_map_encoder>();
    std::vector<std::uint16_t> scratch(TSR_MAP_SCRATCH_COUNT(info.width));
    const tsr_map_reference reference = held ? reference_of(*held) : tsr_map_reference{};
    expect_ok(held ? tsr_map_encode_start_against(encoder.get(), &info, &reference, coded.bytes.data(),
                                                  coded.bytes.size(), scratch.data(), scratch.size())
                   : tsr_map_encode_start(encoder.get(), &info, coded.bytes.data(), coded.bytes.size(), scratch.data(),
                                          scratch.size()));
    expect_ok(tsr_map_encode_rows(encoder.get(), values_q4.data(), info.width, info.height));
    std::size_t len = 0;
    expect_ok(tsr_map_encode_finish(encoder.get(), &len));
    coded.bytes.resize(len);
    expect_ok(tsr_map_read_info(coded.bytes.data(), len, &coded.info));
    return coded;
}

} // namespace tsr

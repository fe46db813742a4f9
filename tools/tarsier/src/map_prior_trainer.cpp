/*
 * Logistic regression over the candidates' tables, and counts for every context.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/coding/map_prior_trainer.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

extern "C" {
#include "tsr/codec/map_packet.h"
}

namespace tsr
{
namespace
{

constexpr int kEpochs = 6;
constexpr double kRate = 0.1;
constexpr double kFirstSquare = 1e-3;        /* keeps AdaGrad's first steps short */
constexpr std::size_t kStride = 7919;        /* prime: questions are met in an order that mixes the maps */
constexpr double kPseudoCount = 2;           /* a context seen n times counts its start as so many more */
constexpr int kProbabilityMin = 64;          /* Q16: where adaptation would stop anyway */
constexpr int kProbabilityMax = 65536 - 64;  /* Q16 */
constexpr std::uint32_t kPacketPixels = 768; /* about what a packet of 90 bytes holds of a map of 160x120 or 320x240 */

template <typename Value>
using Tables = std::array<std::array<std::array<Value, TSR_MAP_TABLE_LEN>, TSR_MAP_TABLE_COUNT>, TSR_MAP_KIND_COUNT>;

double logistic(double log_odds)
{
    return 1 / (1 + std::exp(-log_odds));
}

struct Regression {
    Tables<double> weight{};
    Tables<double> square{};

    void learn(const tsr_map_question &question)
    {
        auto &weights = weight[question.kind];
        auto &squares = square[question.kind];
        double log_odds = 0;
        for (std::size_t table = 0; table < question.table_count; table++) {
            log_odds += weights[table][question.index[table]];
        }
        const double gradient = logistic(log_odds) - (question.bit ? 1 : 0);
        for (std::size_t table = 0; table < question.table_count; table++) {
            double &sum = squares[table][question.index[table]];
            sum += gradient * gradient;
            weights[table][question.index[table]] -= kRate * gradient / std::sqrt(kFirstSquare + sum);
        }
    }
};

std::int8_t rounded_weight(double weight)
{
    return static_cast<std::int8_t>(std::clamp(std::lround(weight * TSR_MAP_WEIGHT_SCALE), -127L, 127L));
}

void keep(void *user, const tsr_map_question *question)
{
    static_cast<std::vector<tsr_map_question> *>(user)->push_back(*question);
}

} // namespace

void MapPriorTrainer::add(const tsr_map_info &info, std::span<const std::uint16_t> map,
                          std::span<const std::uint16_t> reference)
{
    const auto model = std::make_unique<tsr_map_model>();
    std::vector<std::uint16_t> scratch(TSR_MAP_SCRATCH_COUNT(info.width));
    const tsr_map_reference against{reference.data(), info.width, 0};
    const std::size_t pixels = std::size_t{info.width} * info.height;
    if (map.size() != pixels || (!reference.empty() && reference.size() != pixels) ||
        tsr_map_trace(model.get(), &info, reference.empty() ? nullptr : &against, map.data(), scratch.data(),
                      scratch.size(), keep, &questions_) != TSR_OK) {
        throw std::invalid_argument("a map that its info does not admit");
    }
    if (reference.empty() && info.near == 0) {
        add_packets(info, map);
    }
}

void MapPriorTrainer::add_packets(const tsr_map_info &info, std::span<const std::uint16_t> map)
{
    const auto model = std::make_unique<tsr_map_model>();
    std::array<std::uint16_t, TSR_MAP_PACKET_SCRATCH_COUNT> scratch;
    const auto pixels = static_cast<std::uint32_t>(map.size());
    for (std::uint32_t first = 0; first < pixels; first += kPacketPixels) {
        if (tsr_map_trace_packet(model.get(), &info, map.data(), first, std::min(kPacketPixels, pixels - first),
                                 scratch.data(), scratch.size(), keep, &questions_) != TSR_OK) {
            throw std::invalid_argument("a map that its info does not admit");
        }
    }
}

MapPrior MapPriorTrainer::train() const
{
    auto regression = std::make_unique<Regression>();
    for (int epoch = 0; epoch < kEpochs; epoch++) {
        for (std::size_t i = 0, at = 0; i < questions_.size(); i++, at = (at + kStride) % questions_.size()) {
            if (questions_[at].is_candidate) {
                regression->learn(questions_[at]);
            }
        }
    }
    MapPrior prior;
    for (std::size_t kind = 0; kind < TSR_MAP_KIND_COUNT; kind++) {
        for (std::size_t table = 0; table < TSR_MAP_TABLE_COUNT; table++) {
            std::ranges::transform(regression->weight[kind][table], prior.weights[kind][table].begin(), rounded_weight);
        }
    }
    std::vector<std::array<double, 2>> counts(TSR_MAP_CODING_COUNT * TSR_MAP_TRAINED_CELL_COUNT);
    for (const tsr_map_question &question : questions_) {
        if (!question.is_candidate) {
            counts[question.coding * TSR_MAP_TRAINED_CELL_COUNT + question.cell][question.bit ? 1 : 0]++;
        }
    }
    for (std::size_t i = 0; i < counts.size(); i++) {
        const auto [zeros, ones] = counts[i];
        const double p = (ones + kPseudoCount / 2) / (zeros + ones + kPseudoCount);
        prior.cells[i / TSR_MAP_TRAINED_CELL_COUNT][i % TSR_MAP_TRAINED_CELL_COUNT] =
            static_cast<std::uint16_t>(std::clamp<long>(std::lround(p * 65536), kProbabilityMin, kProbabilityMax));
    }
    return prior;
}

namespace
{

constexpr std::size_t kLineLength = 118;

void append_numbers(std::string &text, const auto &numbers)
{
    std::string line = "           ";
    for (const auto number : numbers) {
        const std::string word = fmt::format(" {},", number);
        if (line.size() + word.size() > kLineLength) {
            text += line + "\n";
            line = "           ";
        }
        line += word;
    }
    text += line + "\n";
}

/* Tables first .. end - 1 of every kind. */
void append_weights(std::string &text, const MapPrior &prior, std::size_t first, std::size_t end)
{
    text += "    .weights = {\n";
    for (const MapPrior::Weights &kind : prior.weights) {
        text += "        {\n";
        for (std::size_t table = first; table < end; table++) {
            text += "          {\n";
            append_numbers(text, kind[table]);
            text += "          },\n";
        }
        text += "        },\n";
    }
    text += "    },\n";
}

} // namespace

std::string map_prior_source(const MapPrior &prior, unsigned id, std::uint16_t matcher_crc)
{
    std::string text =
        fmt::format("/*\n * What the map codec knows before it has seen a map. Made by tarsier train-prior: "
                    "train again, do not edit.\n *\n * SPDX-License-Identifier: Apache-2.0\n */\n"
                    "#include \"map_model.h\"\n\n/* clang-format off */\n"
                    "const struct tsr_map_prior tsr_map_prior = {{\n    .id = {},\n"
                    "    .matcher_crc = 0x{:04x},\n",
                    id, matcher_crc);
    append_weights(text, prior, 0, TSR_MAP_TABLE_COUNT_ALONE);
    text += "    .cells = {\n";
    for (std::size_t coding = 0; coding < TSR_MAP_CODING_REFERENCE; coding++) {
        text += "        {\n";
        append_numbers(text, prior.cells[coding]);
        text += "        },\n";
    }
    text += "    },\n};\n\nconst struct tsr_map_reference_prior tsr_map_reference_prior = {\n";
    append_weights(text, prior, TSR_MAP_TABLE_COUNT_ALONE, TSR_MAP_TABLE_COUNT);
    text += "    .cells = {\n";
    append_numbers(text, prior.cells[TSR_MAP_CODING_REFERENCE]);
    return text + "    },\n};\n";
}

} // namespace tsr

/*
 * What the map codec knows before it has seen a map, learned from maps: the
 * tables of log-odds that choose a candidate's context (logistic regression on
 * pairs of neighbours, by AdaGrad: Duchi, Hazan, Singer, 2011), and where each
 * context's probability starts (docs/codec.md, 2.8).
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODING_MAP_PRIOR_TRAINER_H
#define TSR_CODING_MAP_PRIOR_TRAINER_H

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

extern "C" {
#include "tsr/codec/map_trace.h"
}

namespace tsr
{

struct MapPrior {
    using Weights = std::array<std::array<std::int8_t, TSR_MAP_TABLE_LEN>, TSR_MAP_TABLE_COUNT>;
    std::array<Weights, TSR_MAP_KIND_COUNT> weights{};
    std::array<std::array<std::uint16_t, TSR_MAP_TRAINED_CELL_COUNT>, TSR_MAP_CODING_COUNT> cells{};
};

class MapPriorTrainer
{
  public:
    /* All questions of one map, [height][width], values that info admits: as one stream and in packets, or against the
     * reference, of the same shape, if there is one. */
    void add(const tsr_map_info &info, std::span<const std::uint16_t> map, std::span<const std::uint16_t> reference);

    std::size_t question_count() const { return questions_.size(); }

    /* The same questions in the same order give the same prior on the same machine. */
    MapPrior train() const;

  private:
    void add_packets(const tsr_map_info &info, std::span<const std::uint16_t> map);

    std::vector<tsr_map_question> questions_;
};

/* firmware/codec/map_prior.c */
std::string map_prior_source(const MapPrior &prior, unsigned id, std::uint16_t matcher_crc);

} // namespace tsr

#endif

/*
 * Pictures of a crowd: the recorded site's folders, shared by all copies of a
 * pair and played round and round.
 *
 * A frame is decoded once, not once a node, and kept while all folders together have room for it (kCacheMax).
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_CROWD_PICTURES_H
#define TSR_EMULATOR_CROWD_PICTURES_H

#include <map>
#include <memory>
#include <vector>

#include "tsr/emulator/pictures.h"
#include "tsr/hal/recorded_source.h"
#include "tsr/scenario/crowd.h"

namespace tsr
{

class CrowdPictures : public Pictures
{
  public:
    static constexpr std::size_t kCacheMax = std::size_t{128} << 20; /* bytes of pixels */

    /* crowd is kept. Every frame is read, so that none is refused later. Throws InputError. */
    CrowdPictures(const Crowd &crowd, double duration_s);

    std::unique_ptr<FrameSource> source(const SiteNode &node, bool right) override;
    std::uint64_t end_us() const override { return end_us_; }
    /* None: the recorded site's own run compares these pictures with their truth. */
    std::optional<PairTruth> truth(const SitePair &, std::uint64_t) override { return std::nullopt; }

  private:
    struct Recording { /* of one recorded pair */
        std::shared_ptr<RecordedFrames> left;
        std::shared_ptr<RecordedFrames> right;
    };

    const Crowd &crowd_;
    std::vector<Recording> recordings_;          /* of crowd.recorded.pairs */
    std::map<std::uint16_t, std::size_t> pairs_; /* of a node: its pair's index */
    std::uint64_t end_us_;
};

} // namespace tsr

#endif

/*
 * Recorded frames shared by many cameras.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/emulator/crowd_pictures.h"

#include <cmath>

namespace tsr
{

namespace
{

/* Folders are opened once and share the room for their pixels. */
class SharedFolders
{
  public:
    SharedFolders(const Site &recorded, std::size_t cache_max) : recorded_(recorded)
    {
        std::size_t count = 0;
        for (const SiteNode &node : recorded.nodes) {
            count += (node.frames.empty() ? 0u : 1u) + (node.frames_right.empty() ? 0u : 1u);
        }
        cache_max_ = cache_max / count;
    }

    std::shared_ptr<RecordedFrames> open(const std::filesystem::path &folder, std::uint32_t period_ms)
    {
        auto &opened = opened_[{folder, period_ms}];
        if (!opened) {
            opened = std::make_shared<RecordedFrames>(recorded_.resolve(folder), period_ms, cache_max_);
            for (std::size_t i = 0; i < opened->count(); ++i) {
                opened->frame(i);
            }
        }
        return opened;
    }

  private:
    const Site &recorded_;
    std::size_t cache_max_ = 0;
    /* By period too: without times.csv it gives the times. */
    std::map<std::pair<std::filesystem::path, std::uint32_t>, std::shared_ptr<RecordedFrames>> opened_;
};

/* What pauses show: two frames, so that noise goes on. */
std::uint64_t still_ms(const RecordedFrames &frames)
{
    return frames.count() > 2 ? frames.time_ms(2) : frames.length_ms();
}

} // namespace

CrowdPictures::CrowdPictures(const Crowd &crowd, double duration_s)
    : crowd_(crowd), end_us_(static_cast<std::uint64_t>(std::llround(duration_s * 1e6)))
{
    const Site &recorded = crowd.recorded;
    check_recordings(recorded);
    SharedFolders folders(recorded, kCacheMax);
    for (const SitePair &pair : recorded.pairs) {
        const SiteNode &lead = *recorded.node(pair.lead);
        const SiteNode *wing = recorded.node(pair.wing);
        recordings_.push_back({folders.open(lead.frames, lead.watch_period_ms),
                               folders.open(wing != nullptr ? wing->frames : lead.frames_right, lead.watch_period_ms)});
    }
    for (std::size_t i = 0; i < crowd.site.pairs.size(); ++i) {
        pairs_[crowd.site.pairs[i].lead] = i;
        if (crowd.site.pairs[i].wing != kNodeNone) {
            pairs_[crowd.site.pairs[i].wing] = i;
        }
    }
}

/* Both views of a pair go round with its left one. */
std::unique_ptr<FrameSource> CrowdPictures::source(const SiteNode &node, bool right)
{
    const auto pair = pairs_.find(node.id);
    if (pair == pairs_.end() || (right && node.role != Role::binocular)) {
        return nullptr;
    }
    const auto &[original, offset_ms] = crowd_.pairs[pair->second];
    const Recording &seen = recordings_[original];
    return std::make_unique<RecordedSource>(
        right || node.role == Role::wing ? seen.right : seen.left,
        Playback{offset_ms, seen.left->length_ms(), crowd_.pause_ms, still_ms(*seen.left)});
}

} // namespace tsr

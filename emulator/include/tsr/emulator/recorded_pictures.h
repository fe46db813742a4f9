/*
 * Pictures from the folders that a site names.
 *
 * A pair's truth is a folder of PFM disparities named like its frames: the
 * newest file whose name is not after a frame's name holds for that frame, so
 * a still scene needs one file. What happened is in events.csv beside the site
 * file, if there is one whose first line is "time_s,what", as `tarsier render` writes it.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_RECORDED_PICTURES_H
#define TSR_EMULATOR_RECORDED_PICTURES_H

#include <map>

#include "tsr/emulator/pictures.h"
#include "tsr/host/recorded_frames.h"

namespace tsr
{

class RecordedPictures : public Pictures
{
  public:
    /* site is kept. Folders that several nodes name are read once. Throws InputError for a line of events.csv. */
    explicit RecordedPictures(const Site &site);

    std::unique_ptr<FrameSource> source(const SiteNode &node, bool right) override;
    std::uint64_t end_us() const override { return end_us_; }
    std::optional<PairTruth> truth(const SitePair &pair, std::uint64_t time_us) override;
    std::vector<SceneEvent> events() const override { return events_; }

  private:
    std::shared_ptr<RecordedFrames> frames(const std::filesystem::path &folder, std::uint32_t period_ms);

    const Site &site_;
    /* By folder and period: without times.csv the period gives the times. */
    std::map<std::pair<std::filesystem::path, std::uint32_t>, std::shared_ptr<RecordedFrames>> opened_;
    std::uint64_t end_us_ = 0;
    std::vector<SceneEvent> events_;
};

/* The truth file for a frame's file name, or nothing if none holds. */
std::optional<std::filesystem::path> truth_file_for(const std::filesystem::path &folder, const std::string &frame_name);

} // namespace tsr

#endif

/* Maps to look at. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/emulator/gallery.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "tsr/host/colour_map.h"

extern "C" {
#include "tsr/base/disparity.h"
}

namespace tsr
{

namespace
{

constexpr std::array<std::uint8_t, 3> kNoMatch = {110, 110, 110};

class Chosen
{
  public:
    explicit Chosen(const RunRecord &run) : run_(run) {}

    void add(const ReceivedMap &map, const char *why)
    {
        const auto there =
            std::find_if(maps_.begin(), maps_.end(), [&](const GalleryMap &one) { return one.map == &map; });
        if (there != maps_.end()) {
            there->why += std::string(", ") + why;
            return;
        }
        pairs_.insert(map.node);
        maps_.push_back({&map, run_.site->pair_of(map.node), why});
    }
    bool has_pair(std::uint16_t node) const { return pairs_.contains(node); }
    bool full() const { return maps_.size() >= kGalleryMax; }
    std::vector<GalleryMap> take() { return std::move(maps_); }

  private:
    const RunRecord &run_;
    std::set<std::uint16_t> pairs_;
    std::vector<GalleryMap> maps_;
};

/* Of another pair, evenly over what there is. */
void add_others(Chosen &chosen, const std::vector<const ReceivedMap *> &by_time)
{
    for (std::size_t i = 0; i < kGalleryMax && !chosen.full(); ++i) {
        const auto from = by_time.begin() + static_cast<std::ptrdiff_t>(i * by_time.size() / kGalleryMax);
        const auto other =
            std::find_if(from, by_time.end(), [&](const ReceivedMap *map) { return !chosen.has_pair(map->node); });
        if (other != by_time.end()) {
            chosen.add(**other, "");
        }
    }
}

RgbImage colour_truth(const FloatImage &truth, int disparities)
{
    std::vector<std::uint16_t> disparity_q4;
    disparity_q4.reserve(truth.pixels.size());
    for (const float value : truth.pixels) {
        const double q4 = std::round(static_cast<double>(value) * TSR_DISPARITY_ONE_Q4);
        disparity_q4.push_back(std::isfinite(value)
                                   ? static_cast<std::uint16_t>(std::clamp(q4, 0.0, TSR_DISPARITY_INVALID - 1.0))
                                   : TSR_DISPARITY_INVALID);
    }
    return colour_disparity(disparity_q4, truth.width, truth.height, disparities);
}

} // namespace

std::vector<GalleryMap> choose_maps(const RunRecord &run)
{
    Chosen chosen(run);
    if (run.maps.size() <= kGalleryMax) {
        for (const ReceivedMap &map : run.maps) {
            chosen.add(map, "");
        }
        return chosen.take();
    }
    std::vector<const ReceivedMap *> by_time;
    std::vector<const ReceivedMap *> by_error;
    for (const ReceivedMap &map : run.maps) {
        by_time.push_back(&map);
        if (map.error) {
            by_error.push_back(&map);
        }
    }
    std::stable_sort(by_time.begin(), by_time.end(), [](const ReceivedMap *a, const ReceivedMap *b) {
        return a->capture_time_us < b->capture_time_us;
    });
    std::stable_sort(by_error.begin(), by_error.end(),
                     [](const ReceivedMap *a, const ReceivedMap *b) { return a->error->correct > b->error->correct; });
    if (!by_error.empty()) {
        chosen.add(*by_error.front(), "best");
        chosen.add(*by_error[(by_error.size() - 1) / 2], "median");
        chosen.add(*by_error.back(), "worst");
    }
    chosen.add(*by_time.back(), "newest");
    add_others(chosen, by_time);
    return chosen.take();
}

RgbImage colour_error(const FloatImage &map, const FloatImage &truth)
{
    RgbImage image{map.width, map.height, std::vector<std::uint8_t>(3 * map.pixels.size(), 0)};
    for (std::size_t i = 0; i < map.pixels.size(); ++i) {
        if (!std::isfinite(truth.pixels[i])) {
            continue;
        }
        const double error_px = std::abs(static_cast<double>(map.pixels[i]) - static_cast<double>(truth.pixels[i]));
        const auto colour = std::isfinite(map.pixels[i]) ? viridis(error_px / kErrorShownPx) : kNoMatch;
        std::copy(colour.begin(), colour.end(), image.pixels.begin() + static_cast<std::ptrdiff_t>(3 * i));
    }
    return image;
}

void write_truth_pictures(const std::filesystem::path &out, const std::vector<GalleryMap> &maps, Pictures &pictures)
{
    for (const GalleryMap &shown : maps) {
        const auto truth = shown.map->error ? pictures.truth(*shown.pair, shown.map->capture_time_us) : std::nullopt;
        if (truth) {
            const FloatImage map = read_pfm(out / (shown.map->file + ".pfm"));
            write_png(out / (shown.map->file + "-truth.png"),
                      colour_truth(truth->disparity_px, shown.pair->disparities));
            write_png(out / (shown.map->file + "-error.png"), colour_error(map, truth->disparity_px));
        }
    }
}

} // namespace tsr

/*
 * tarsier compare MAP TRUTH [--mask M] [--range PX] [--json]
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "commands.h"
#include "tsr/host/image_file.h"
#include "tsr/host/input_error.h"
#include "tsr/host/output_files.h"
#include "tsr/stereo/disparity_file.h"
#include "tsr/stereo/map_quality.h"

namespace tsr
{
namespace
{

using Json = nlohmann::ordered_json;

constexpr std::uint8_t kMaskJudged = 255;

struct CompareOptions {
    std::filesystem::path map;
    std::filesystem::path truth;
    std::filesystem::path mask;
    std::optional<double> range_px;
    bool json = false;
};

std::string shape_of(int width, int height)
{
    return std::to_string(width) + "x" + std::to_string(height);
}

void expect_size(const std::filesystem::path &file, int width, int height, const FloatImage &map,
                 const std::filesystem::path &map_file)
{
    if (width != map.width || height != map.height) {
        throw InputError(file.string(), "size",
                         shape_of(width, height) + ", " + map_file.string() + " has " +
                             shape_of(map.width, map.height));
    }
}

std::vector<bool> read_mask(const CompareOptions &options, const FloatImage &map)
{
    std::vector<bool> admitted;
    if (!options.mask.empty()) {
        const GrayImage mask = read_gray_image(options.mask);
        expect_size(options.mask, mask.width, mask.height, map, options.map);
        admitted.reserve(mask.pixels.size());
        for (const std::uint8_t value : mask.pixels) {
            admitted.push_back(value == kMaskJudged);
        }
    }
    return admitted;
}

/* "0.5", "1", "2" */
std::string threshold_name(double threshold)
{
    std::string text = std::to_string(threshold);
    text.erase(text.find_last_not_of('0') + 1);
    return text.back() == '.' ? text.substr(0, text.size() - 1) : text;
}

/* JSON has no infinity and no not-a-number: null. */
void print_json(const FloatImage &map, const MapQuality &quality)
{
    const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); };
    Json correct;
    Json bad;
    for (std::size_t t = 0; t < kQualityThresholds.size(); t++) {
        correct[threshold_name(kQualityThresholds[t])] = number(quality.correct[t]);
        bad[threshold_name(kQualityThresholds[t])] = number(quality.bad[t]);
    }
    const Json json = {{"width", map.width},
                       {"height", map.height},
                       {"known", quality.known},
                       {"valid", quality.valid},
                       {"density", quality.density()},
                       {"correct", correct},
                       {"bad", bad},
                       {"median_error_px", number(quality.median_error_px)},
                       {"mean_error_px", number(quality.mean_error_px)},
                       {"mse_px2", number(quality.mse_px2)},
                       {"range_px", quality.range_px},
                       {"psnr_db", number(quality.psnr_db)},
                       {"ssim", number(quality.ssim)}};
    std::cout << json.dump(1) << "\n";
}

void print_text(const FloatImage &map, const MapQuality &quality)
{
    if (quality.valid == 0) {
        std::printf("%dx%d, %zu px known, none of them valid: nothing to judge\n", map.width, map.height,
                    quality.known);
        return;
    }
    std::printf("%dx%d, %zu px known, %.1f %% of them valid\n", map.width, map.height, quality.known,
                100 * quality.density());
    std::printf("within   ");
    for (const double threshold : kQualityThresholds) {
        std::printf("%6s px", threshold_name(threshold).c_str());
    }
    std::printf("\ncorrect  ");
    for (const double part : quality.correct) {
        std::printf("%9.4f", part);
    }
    std::printf("   of the known\nbad      ");
    for (const double part : quality.bad) {
        std::printf("%9.4f", part);
    }
    std::printf("   of the valid\n|error|   median %.4f px, mean %.4f px\n", quality.median_error_px,
                quality.mean_error_px);
    std::printf("MSE       %.4f px^2, PSNR %.2f dB, SSIM %.4f (dynamic range %.4g px)\n", quality.mse_px2,
                quality.psnr_db, quality.ssim, quality.range_px);
}

int compare(const CompareOptions &options)
{
    if (options.range_px && !(*options.range_px > 0 && std::isfinite(*options.range_px))) {
        throw InputError("command line", "--range", "must be above 0 px");
    }
    const FloatImage map = read_disparity_file(options.map);
    const FloatImage truth = read_disparity_file(options.truth);
    expect_size(options.truth, truth.width, truth.height, map, options.map);
    const std::vector<bool> admitted = read_mask(options, map);
    if (count_known(truth, admitted) == 0) {
        throw InputError(admitted.empty() ? options.truth.string() : options.mask.string(), "pixels",
                         admitted.empty() ? "no disparity is known"
                                          : "no disparity is known where it is 255, in " + options.truth.string());
    }
    const MapQuality quality = judge_map(map, truth, admitted, options.range_px);
    if (!(quality.range_px > 0)) {
        throw InputError(options.truth.string(), "pixels", "no disparity above 0 px: give --range");
    }
    if (options.json) {
        print_json(map, quality);
    } else {
        print_text(map, quality);
    }
    return 0;
}

} // namespace

Command declare_compare(CLI::App &command)
{
    auto options = std::make_shared<CompareOptions>();
    command.add_option("map", options->map, "disparity map: PFM, or PNG of 16 bits, px = value / 256")->required();
    command.add_option("truth", options->truth, "true disparities, in either format")->required();
    command.add_option("--mask", options->mask, "judge only where this picture is 255")->check(refuse_empty_name);
    command.add_option("--range", options->range_px, "dynamic range of PSNR and SSIM, px; default: largest truth");
    command.add_flag("--json", options->json, "print JSON");
    return [options] { return compare(*options); };
}

} // namespace tsr

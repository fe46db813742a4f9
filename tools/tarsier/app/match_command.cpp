/*
 * tarsier match LEFT RIGHT --disparities N [...] -o OUT
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "commands.h"
#include "match_options.h"
#include "tsr/host/colour_map.h"
#include "tsr/host/input_error.h"
#include "tsr/host/output_files.h"
#include "tsr/stereo/disparity_file.h"

namespace tsr
{
namespace
{

using Json = nlohmann::ordered_json;

/* Largest whole disparity of a 16-bit PNG, px. */
constexpr int kPngDisparityMax = 65535 / kDisparityPngScale;

void check_range(const MatchOptions &options)
{
    const bool is_png = disparity_format(options.out, "--out") == DisparityFormat::kPng;
    if (is_png && options.search_start < 0) {
        throw InputError(options.out.string(), "--out",
                         "a PNG holds no disparity below 0, which --search-start asks for: write .pfm");
    }
    const int disparities = std::min(options.disparities, static_cast<int>(TSR_DISPARITY_COUNT_MAX));
    if (is_png && options.search_start > kPngDisparityMax + 1 - disparities) {
        throw InputError(options.out.string(), "--out",
                         "a PNG holds no disparity above " + std::to_string(kPngDisparityMax) +
                             " px, which --search-start asks for: write .pfm");
    }
}

/* Before anything is read. */
void check_files(const MatchOptions &options)
{
    check_range(options);
    if (!options.picture.empty() && options.picture.extension() != ".png") {
        throw InputError(options.picture.string(), "--png", "the name does not end in .png");
    }
    std::vector<OutputFile> outputs = {{options.out, "--out"}};
    if (!options.picture.empty()) {
        outputs.push_back({options.picture, "--png"});
    }
    check_outputs(outputs, {options.left, options.right});
}

GrayImage read_right(const MatchOptions &options, const ImageSize &size)
{
    GrayImage right = read_gray_image(options.right);
    if (right.size() != size) {
        throw InputError(options.right.string(), "size",
                         std::to_string(right.width) + "x" + std::to_string(right.height) + ", " +
                             options.left.string() + " has " + std::to_string(size.width) + "x" +
                             std::to_string(size.height));
    }
    return right;
}

/* Between the views: the map's disparities count from the search start. */
FloatImage view_disparity(const StereoResult &result, const tsr_match_config &config)
{
    FloatImage map = float_disparity(result.disparity_q4, config.width, config.height);
    for (float &disparity : map.pixels) {
        disparity += config.search_start_px; /* infinity stays */
    }
    return map;
}

double density_of(const StereoResult &result)
{
    const auto invalid = std::count(result.disparity_q4.begin(), result.disparity_q4.end(), TSR_DISPARITY_INVALID);
    return 1 - static_cast<double>(invalid) / static_cast<double>(result.disparity_q4.size());
}

/* The picture first: where the map is, all is. */
void write_outputs(const MatchOptions &options, const StereoResult &result, const tsr_match_config &config)
{
    if (!options.picture.empty()) {
        write_png(options.picture,
                  colour_disparity(result.disparity_q4, config.width, config.height, config.disparities));
    }
    EarlierOutput picture(options.picture);
    write_disparity_file(options.out, view_disparity(result, config));
    picture.keep();
}

/* A test that is off is null. */
Json test_value(std::uint8_t value)
{
    return value == TSR_MATCH_TEST_OFF ? Json(nullptr) : Json(value);
}

void print_json(const MatchOptions &options, const StereoPipeline &pipeline, const StereoResult &result)
{
    const tsr_match_config &config = pipeline.match_config();
    const bool has_texture = config.mode == TSR_MATCH_SAD || config.mode == TSR_MATCH_SAD8;
    const std::size_t pixels = result.disparity_q4.size();
    const Json json = {{"width", config.width},
                       {"height", config.height},
                       {"disparities", config.disparities},
                       {"search_start_px", config.search_start_px},
                       {"mode", options.mode},
                       {"kernel", tsr_match_kernel_name(config.kernel)},
                       {"window", config.mode == TSR_MATCH_SMOOTH ? Json(nullptr) : Json(config.window)},
                       {"uniqueness_percent", test_value(config.uniqueness_percent)},
                       {"texture_min", has_texture ? test_value(config.texture_min) : Json(nullptr)},
                       {"lr_tolerance_px", test_value(config.lr_tolerance_px)},
                       {"refine", refine_steps(options)},
                       {"density", density_of(result)},
                       {"match_ms", result.match_ms},
                       {"refine_ms", result.refine_ms},
                       {"match_scratch_bytes", pipeline.match_scratch_len()},
                       {"refine_scratch_bytes", pipeline.refine_scratch_len()},
                       {"frames_bytes", 2 * pixels},
                       {"map_bytes", sizeof(std::uint16_t) * pixels},
                       {"out", options.out.string()}};
    std::cout << json.dump(1, ' ', false, Json::error_handler_t::replace) << "\n";
}

void print_text(const MatchOptions &options, const StereoPipeline &pipeline, const StereoResult &result)
{
    const tsr_match_config &config = pipeline.match_config();
    std::printf("%s: %ux%u, %.1f %% valid, match %.1f ms (%s), refine %.1f ms, scratch %zu and %zu bytes\n",
                options.out.c_str(), config.width, config.height, 100 * density_of(result), result.match_ms,
                tsr_match_kernel_name(config.kernel), result.refine_ms, pipeline.match_scratch_len(),
                pipeline.refine_scratch_len());
}

int match(const MatchOptions &options)
{
    check_files(options);
    const GrayImage left = read_gray_image(options.left);
    const StereoOptions stereo = read_match_options(options, left.size());
    const GrayImage right = read_right(options, left.size());
    StereoPipeline pipeline(stereo);
    const StereoResult result = pipeline.run(left, right);
    write_outputs(options, result, pipeline.match_config());
    if (options.json) {
        print_json(options, pipeline, result);
    } else {
        print_text(options, pipeline, result);
    }
    return 0;
}

} // namespace

Command declare_match(CLI::App &command)
{
    auto options = std::make_shared<MatchOptions>();
    declare_match_options(command, *options);
    return [options] { return match(*options); };
}

} // namespace tsr

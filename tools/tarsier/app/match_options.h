/*
 * The command line of `tarsier match`.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TARSIER_MATCH_OPTIONS_H
#define TSR_TARSIER_MATCH_OPTIONS_H

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "tsr/host/image_file.h"
#include "tsr/stereo/stereo_pipeline.h"

namespace tsr
{

/* As typed; what is not, is the mode's own default. */
struct MatchOptions {
    std::filesystem::path left;
    std::filesystem::path right;
    std::filesystem::path out;
    std::filesystem::path picture;
    int disparities = 0;
    std::optional<int> window;
    std::string mode = "sad";
    std::string refine = "median3";
    int search_start = 0;
    std::optional<std::string> uniqueness;
    std::optional<std::string> texture;
    std::string lr = "1";
    std::optional<int> speckle_size;
    std::optional<double> speckle_difference_px;
    std::optional<int> diffusion_iterations;
    std::optional<double> diffusion_edge_px;
    bool json = false;
};

void declare_match_options(CLI::App &command, MatchOptions &options);

/* The steps of --refine, without "none". */
std::vector<std::string> refine_steps(const MatchOptions &options);

/* What the pipeline takes. Throws InputError naming the option that is out of
 * its range, or the left picture if the matcher cannot take its size. */
StereoOptions read_match_options(const MatchOptions &options, const ImageSize &size);

} // namespace tsr

#endif

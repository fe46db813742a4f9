/*
 * tarsier train-prior DIR... -o map_prior.c [--step PX]... [--id N]
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "coded_map_options.h"
#include "commands.h"
#include "tsr/coding/coded_map.h"
#include "tsr/coding/disparity_values.h"
#include "tsr/coding/map_prior_trainer.h"
#include "tsr/coding/matcher_fingerprint.h"
#include "tsr/host/atomic_file.h"
#include "tsr/host/command_line.h"
#include "tsr/host/input_error.h"
#include "tsr/host/output_files.h"
#include "tsr/stereo/disparity_file.h"

namespace tsr
{
namespace
{

struct TrainOptions {
    std::vector<std::filesystem::path> folders;
    std::filesystem::path out;
    std::vector<double> steps{1, 0.5, 0.25};
    unsigned id = 1;
};

/* By its name: what is not a file is refused where it is read. */
bool is_map_file(const std::filesystem::path &path)
{
    const std::string ending = path.extension().string();
    return ending == ".pfm" || ending == ".png";
}

struct Folder {
    std::vector<std::filesystem::path> maps;
    std::vector<std::filesystem::path> folders;
};

Folder read_folder(const std::filesystem::path &path)
{
    std::error_code error;
    Folder folder;
    for (const auto &entry : std::filesystem::directory_iterator(path, error)) {
        std::error_code unknown; /* a link to nowhere is no folder */
        if (entry.is_directory(unknown)) {
            folder.folders.push_back(entry.path());
        } else if (is_map_file(entry.path())) {
            folder.maps.push_back(entry.path());
        }
    }
    if (error) {
        throw InputError(path.string(), "folder", error.message());
    }
    std::ranges::sort(folder.maps);
    std::ranges::sort(folder.folders);
    return folder;
}

void add(MapPriorTrainer &trainer, const TrainOptions &options, const DisparityValues &map,
         const DisparityValues *earlier)
{
    for (const double step : options.steps) {
        tsr_map_info info{};
        info.width = map.width;
        info.height = map.height;
        info.disparities = map.disparities;
        info.step_log2 = log2_of_step(step);
        for (info.near = 0; info.near <= TSR_MAP_NEAR_MAX; info.near++) {
            auto values = quantised(map, info.step_log2);
            std::vector<std::uint16_t> reference;
            if (earlier != nullptr) {
                reference = quantised(*earlier, info.step_log2);
                values = held_to(info, values, reference);
            }
            trainer.add(info, values, reference);
        }
    }
}

DisparityValues read_map(const std::filesystem::path &file)
{
    return disparity_values(read_disparity_file(file), file);
}

/* Maps of one static camera, in the order of their names: each against the one before. */
std::size_t add_sequence(MapPriorTrainer &trainer, const TrainOptions &options, const std::filesystem::path &path)
{
    const Folder folder = read_folder(path);
    DisparityValues earlier;
    for (std::size_t i = 0; i < folder.maps.size(); i++) {
        DisparityValues map = read_map(folder.maps[i]);
        if (i > 0 && (map.width != earlier.width || map.height != earlier.height)) {
            throw InputError(folder.maps[i].string(), "size", "another than that of " + folder.maps[i - 1].string());
        }
        if (i > 0) {
            add(trainer, options, map, &earlier);
        }
        earlier = std::move(map);
    }
    return folder.maps.empty() ? 0 : folder.maps.size() - 1;
}

int train(const TrainOptions &options)
{
    if (options.out.extension() != ".c") {
        throw InputError(options.out.string(), "--out", "the name does not end in .c");
    }
    MapPriorTrainer trainer;
    std::size_t alone = 0, following = 0;
    for (const auto &path : options.folders) {
        const Folder folder = read_folder(path);
        const std::size_t before = alone + following;
        for (const auto &file : folder.maps) {
            add(trainer, options, read_map(file), nullptr);
            alone++;
        }
        for (const auto &sequence : folder.folders) {
            following += add_sequence(trainer, options, sequence);
        }
        if (alone + following == before) {
            throw InputError(path.string(), "folder", "no map (.pfm, .png) in it, and no two in a folder inside");
        }
    }
    const std::string source = map_prior_source(trainer.train(), options.id, matcher_fingerprint());
    write_file_atomically(options.out, source);
    std::printf("%s: %zu maps alone, %zu after another, %zu questions\n", options.out.c_str(), alone, following,
                trainer.question_count());
    return 0;
}

} // namespace

Command declare_train_prior(CLI::App &command)
{
    auto options = std::make_shared<TrainOptions>();
    command
        .add_option("DIR", options->folders,
                    "folders of maps (.pfm, or .png of 16 bits); a folder inside is a sequence of one static camera")
        ->required();
    command.add_option("-o,--out", options->out, "C source to write")->required()->check(refuse_empty_name);
    command.add_option("--step", options->steps, "one or more, px, after the folders; default: 1 0.5 0.25")
        ->check(is_map_step());
    command.add_option("--id", options->id, "of the prior, in every coded map's header")
        ->check(CLI::Range(1, 15))
        ->capture_default_str();
    return [options] { return train(*options); };
}

} // namespace tsr

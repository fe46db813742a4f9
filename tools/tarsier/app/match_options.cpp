/*
 * Options to configuration: a matcher's mode or a filter is one line of a table.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_options.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "tsr/host/input_error.h"
#include "tsr/host/output_files.h"

namespace tsr
{
namespace
{

/* What a mode takes of --window (null: it has its own) and whether it tests texture. */
struct Mode {
    std::string_view name;
    tsr_match_mode mode;
    const char *window;
    bool has_texture;
};
constexpr const char *kAnyWindow = "odd, 5 .. 15, at most the height of the pictures";
constexpr std::array kModes = {
    Mode{"sad", TSR_MATCH_SAD, kAnyWindow, true},
    Mode{"sad8", TSR_MATCH_SAD8, "odd, 5 .. 11 in mode sad8, at most the height of the pictures", true},
    Mode{"census", TSR_MATCH_CENSUS, kAnyWindow, false},
    Mode{"smooth", TSR_MATCH_SMOOTH, nullptr, false},
    Mode{"raw", TSR_MATCH_RAW, kAnyWindow, false},
    Mode{"ssd", TSR_MATCH_SSD, kAnyWindow, false},
};

struct Step {
    std::string_view name;
    tsr_refine_step step;
};
constexpr std::array kSteps = {Step{"median3", TSR_REFINE_MEDIAN3},     Step{"median5", TSR_REFINE_MEDIAN5},
                               Step{"speckle", TSR_REFINE_SPECKLE},     Step{"fill", TSR_REFINE_FILL},
                               Step{"gaussian3", TSR_REFINE_GAUSSIAN3}, Step{"gaussian5", TSR_REFINE_GAUSSIAN5},
                               Step{"diffusion", TSR_REFINE_DIFFUSION}};

/* A field of the configuration, the option that sets it, and what it takes. */
struct Field {
    std::string_view field;
    const char *option;
    const char *takes;
};
constexpr std::array kFields = {
    Field{"disparities", "--disparities", "16 .. 128, a multiple of 8, at most the width of the pictures"},
    Field{"uniqueness_percent", "--uniqueness", "1 .. 100, or off"},
    Field{"texture_min", "--texture", "1 .. 127, or off"},
    Field{"lr_tolerance_px", "--lr", "1 .. 127, or off"},
    Field{"search_start_px", "--search-start", "at most width - disparities, to either side"},
    Field{"min_size", "--speckle-size", "2 .. 4096"},
    Field{"max_difference_q4", "--speckle-difference", "1/16 .. 4095 15/16 px"},
    Field{"iterations", "--diffusion-iterations", "1 .. 100"},
    Field{"edge_q4", "--diffusion-edge", "1/16 .. 15 15/16 px"},
};

[[noreturn]] void refuse(std::string_view field)
{
    const auto *found = std::find_if(kFields.begin(), kFields.end(), [&](const Field &f) { return f.field == field; });
    if (found == kFields.end()) {
        throw InputError("command line", std::string(field), "out of range");
    }
    throw InputError("command line", found->option, std::string("takes ") + found->takes);
}

/* Zero would mean the default, so it is refused where it is not a value of its own. */
template <typename T> T narrow(long value, std::string_view field)
{
    if (value <= 0 || value > static_cast<long>(std::numeric_limits<T>::max())) {
        refuse(field);
    }
    return static_cast<T>(value);
}

template <typename T> T sixteenths(double px, std::string_view field)
{
    if (!(px > 0 && px < 65536)) {
        refuse(field);
    }
    return narrow<T>(std::lround(px * TSR_DISPARITY_ONE_Q4), field);
}

std::uint8_t read_test(const std::string &text, std::string_view field)
{
    if (text == "off") {
        return TSR_MATCH_TEST_OFF;
    }
    int value = 0;
    const char *end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || at != end || value == TSR_MATCH_TEST_OFF) {
        refuse(field);
    }
    return narrow<std::uint8_t>(value, field);
}

/* The entry of a table with this name; refused with all names if there is none. */
template <typename Table>
const typename Table::value_type &find_name(const Table &table, const std::string &name, const char *option)
{
    std::string names;
    for (const auto &entry : table) {
        if (entry.name == name) {
            return entry;
        }
        names += (names.empty() ? "" : ", ") + std::string(entry.name);
    }
    throw InputError("command line", option, "'" + name + "' is none of: " + names);
}

[[noreturn]] void refuse_window(const Mode &mode)
{
    throw InputError("command line", "--window", std::string("takes ") + mode.window);
}

/* The mode, and what it makes of --window and --texture. */
void read_mode(const MatchOptions &options, const Mode &mode, tsr_match_config &config)
{
    config.mode = static_cast<std::uint8_t>(mode.mode);
    if (options.window && mode.window == nullptr) {
        throw InputError("command line", "--window", "mode " + std::string(mode.name) + " has a window of its own");
    }
    if (options.texture && !mode.has_texture && *options.texture != "off") {
        throw InputError("command line", "--texture", "mode " + std::string(mode.name) + " has no test of texture");
    }
    if (options.window) {
        if (*options.window <= 0 || *options.window > std::numeric_limits<std::uint8_t>::max()) {
            refuse_window(mode);
        }
        config.window = static_cast<std::uint8_t>(*options.window);
    }
    config.texture_min = options.texture ? read_test(*options.texture, "texture_min") : std::uint8_t{0};
}

/* Whether an option of a filter was given, which that filter must then be there for. */
template <typename T>
bool is_given(const std::optional<T> &option, const char *name, const std::vector<std::string> &steps, const char *step)
{
    if (option && std::find(steps.begin(), steps.end(), step) == steps.end()) {
        throw InputError("command line", name, std::string("--refine has no ") + step);
    }
    return option.has_value();
}

tsr_refine_config read_refine(const MatchOptions &options)
{
    tsr_refine_config config = {};
    const std::vector<std::string> steps = refine_steps(options);
    if (steps.size() > TSR_REFINE_STEPS_MAX) {
        throw InputError("command line", "--refine", "at most " + std::to_string(TSR_REFINE_STEPS_MAX) + " filters");
    }
    for (std::size_t i = 0; i < steps.size(); i++) {
        config.steps[i] = static_cast<std::uint8_t>(find_name(kSteps, steps[i], "--refine").step);
    }
    if (is_given(options.speckle_size, "--speckle-size", steps, "speckle")) {
        config.speckle.min_size = narrow<std::uint16_t>(*options.speckle_size, "min_size");
    }
    if (is_given(options.speckle_difference_px, "--speckle-difference", steps, "speckle")) {
        config.speckle.max_difference_q4 =
            sixteenths<std::uint16_t>(*options.speckle_difference_px, "max_difference_q4");
    }
    if (is_given(options.diffusion_iterations, "--diffusion-iterations", steps, "diffusion")) {
        config.diffusion.iterations = narrow<std::uint8_t>(*options.diffusion_iterations, "iterations");
    }
    if (is_given(options.diffusion_edge_px, "--diffusion-edge", steps, "diffusion")) {
        config.diffusion.edge_q4 = sixteenths<std::uint8_t>(*options.diffusion_edge_px, "edge_q4");
    }
    return config;
}

std::string without_blanks(std::string text)
{
    std::erase(text, ' ');
    return text;
}

} // namespace

void declare_match_options(CLI::App &command, MatchOptions &options)
{
    command.add_option("left", options.left, "left picture, rectified: PGM, PNG or JPEG")->required();
    command.add_option("right", options.right, "right picture, of the same size")->required();
    command.add_option("--disparities", options.disparities, "searched disparities, px: 16 .. 128, a multiple of 8")
        ->required();
    command.add_option("--window", options.window,
                       "side of the window, px: odd, 5 .. 15, in sad8 up to 11; 9 unless told, smooth has its own");
    command.add_option("--mode", options.mode, "sad, sad8, census, smooth, raw or ssd")->capture_default_str();
    command
        .add_option("--refine", options.refine,
                    "filters of the map in order, with commas, or none: median3 median5 speckle fill gaussian3 "
                    "gaussian5 diffusion")
        ->capture_default_str();
    command.add_option("--search-start", options.search_start, "first disparity searched, px")->capture_default_str();
    command.add_option("--uniqueness", options.uniqueness,
                       "1 .. 100 percent, or off; 15 unless told, in smooth 25, in ssd 30");
    command.add_option("--texture", options.texture, "1 .. 127, or off, in sad and sad8; 1 unless told");
    command.add_option("--lr", options.lr, "left-right tolerance, 1 .. 127 px, or off")->capture_default_str();
    command.add_option("--speckle-size", options.speckle_size, "smallest island kept, 2 .. 4096 px; 50 unless told");
    command.add_option("--speckle-difference", options.speckle_difference_px,
                       "largest step inside an island, px; 1 unless told");
    command.add_option("--diffusion-iterations", options.diffusion_iterations, "1 .. 100; 5 unless told");
    command.add_option("--diffusion-edge", options.diffusion_edge_px, "what counts as an edge, px; 1 unless told");
    command.add_option("-o,--out", options.out, "the map: .pfm, or .png of 16 bits, px = value / 256")
        ->required()
        ->check(refuse_empty_name);
    command.add_option("--png", options.picture, "the map in colours, a PNG to look at")->check(refuse_empty_name);
    command.add_flag("--json", options.json, "print JSON");
}

std::vector<std::string> refine_steps(const MatchOptions &options)
{
    const std::string refine = without_blanks(options.refine);
    std::vector<std::string> steps;
    std::size_t begin = 0;
    while (refine != "none" && begin <= refine.size()) {
        const std::size_t end = std::min(refine.find(',', begin), refine.size());
        steps.push_back(refine.substr(begin, end - begin));
        begin = end + 1;
    }
    if (steps.size() > 1 && std::find(steps.begin(), steps.end(), "none") != steps.end()) {
        throw InputError("command line", "--refine", "'none' stands alone");
    }
    return steps;
}

StereoOptions read_match_options(const MatchOptions &options, const ImageSize &size)
{
    if (size.width < TSR_MATCH_DISPARITIES_MIN || size.width > TSR_IMAGE_WIDTH_MAX || size.height < 5 ||
        size.height > TSR_IMAGE_HEIGHT_MAX) {
        throw InputError(options.left.string(), "size",
                         std::to_string(size.width) + "x" + std::to_string(size.height) +
                             ", the matcher takes 16x5 to 640x480");
    }
    StereoOptions stereo;
    stereo.match.width = static_cast<std::uint16_t>(size.width);
    stereo.match.height = static_cast<std::uint16_t>(size.height);
    stereo.match.disparities = narrow<std::uint16_t>(options.disparities, "disparities");
    const Mode &mode = find_name(kModes, options.mode, "--mode");
    read_mode(options, mode, stereo.match);
    if (options.uniqueness) {
        stereo.match.uniqueness_percent = read_test(*options.uniqueness, "uniqueness_percent");
    }
    stereo.match.lr_tolerance_px = read_test(options.lr, "lr_tolerance_px");
    stereo.match.search_start_px =
        static_cast<std::int16_t>(std::clamp(options.search_start, -TSR_IMAGE_WIDTH_MAX, +TSR_IMAGE_WIDTH_MAX));
    stereo.refine = read_refine(options);
    if (const std::string field = StereoPipeline::bad_field(stereo); !field.empty()) {
        if (field == "window") {
            refuse_window(mode);
        }
        if (field == "height") {
            throw InputError(options.left.string(), "size",
                             std::to_string(size.height) + " rows, mode smooth takes at least 7");
        }
        refuse(field);
    }
    return stereo;
}

} // namespace tsr

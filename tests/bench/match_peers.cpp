/*
 * The matcher beside OpenCV's StereoBM and StereoSGBM, in one process and one
 * thread: times of every kernel, bytes of every mode, and quality on pairs with
 * ground truth. JSON.
 *
 *   match_peers PICTURE_LEFT PICTURE_RIGHT [FOLDER_OF_PAIRS]
 *
 * Times are medians over rounds in which every matcher runs kTurns times in a
 * row, as on a stream of frames. FOLDER/mb*
 * hold left.png, right.png and gt256_left.png (disparity = value / 256, 0
 * unknown); they are cut to 4:3 in the middle and reduced by area.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tsr/stereo/stereo_pipeline.h"

namespace
{

using nlohmann::json;

struct Case {
    int width;
    int height;
    int disparities;
    int rounds;
};

constexpr int kTurns = 3;
constexpr Case kCases[] = {{160, 120, 32, 41}, {320, 240, 64, 15}, {640, 480, 128, 5}};
constexpr Case kMemoryCases[] = {{160, 120, 32, 0}, {320, 240, 48, 0}, {320, 240, 64, 0}};

cv::Ptr<cv::StereoBM> block_matcher(int disparities)
{
    auto matcher = cv::StereoBM::create(disparities, 9);
    matcher->setPreFilterType(cv::StereoBM::PREFILTER_XSOBEL);
    matcher->setPreFilterCap(31);
    matcher->setUniquenessRatio(15);
    matcher->setTextureThreshold(10);
    matcher->setDisp12MaxDiff(1);
    matcher->setSpeckleWindowSize(0);
    return matcher;
}

cv::Ptr<cv::StereoSGBM> semi_global_matcher(int disparities)
{
    return cv::StereoSGBM::create(0, disparities, 5, 8 * 25, 32 * 25, 1, 31, 10, 0, 0);
}

tsr::GrayImage gray_of(const cv::Mat &picture)
{
    tsr::GrayImage image;
    image.width = static_cast<std::uint16_t>(picture.cols);
    image.height = static_cast<std::uint16_t>(picture.rows);
    image.pixels.assign(picture.datastart, picture.dataend);
    return image;
}

tsr::StereoOptions options_of(const Case &shape, std::uint8_t mode, const std::vector<tsr_refine_step> &steps)
{
    tsr::StereoOptions options;
    options.match.width = static_cast<std::uint16_t>(shape.width);
    options.match.height = static_cast<std::uint16_t>(shape.height);
    options.match.disparities = static_cast<std::uint16_t>(shape.disparities);
    options.match.mode = mode;
    std::copy(steps.begin(), steps.end(), options.refine.steps);
    options.refine.speckle.min_size = static_cast<std::uint16_t>(shape.width * 60 / 160);
    return options;
}

double seconds_of(const std::function<void()> &work)
{
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median_of(std::vector<double> values)
{
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
}

cv::Mat reduced(const cv::Mat &picture, const Case &shape)
{
    cv::Mat small;
    cv::resize(picture, small, {shape.width, shape.height}, 0, 0, cv::INTER_AREA);
    return small;
}

struct Contender {
    std::string name;
    std::function<void()> run;
};

tsr_gray view_of(cv::Mat &picture)
{
    return {picture.data, static_cast<std::uint16_t>(picture.cols), static_cast<std::uint16_t>(picture.rows),
            static_cast<std::uint16_t>(picture.step)};
}

/* One map, the copies of the views that the matcher consumes included. */
Contender our_contender(const Case &shape, tsr_match_mode mode, const char *mode_name, const tsr_match_kernel *kernel,
                        const cv::Mat &left, const cv::Mat &right)
{
    tsr_match_config config = options_of(shape, static_cast<std::uint8_t>(mode), {}).match;
    config.kernel = kernel;
    auto scratch = std::make_shared<std::vector<std::uint32_t>>(tsr_match_scratch_len(&config) / 4 + 1);
    auto map = std::make_shared<std::vector<std::uint16_t>>(left.total());
    return {std::string(tsr_match_kernel_name(kernel)) + " " + mode_name, [=] {
                cv::Mat first = left.clone();
                cv::Mat second = right.clone();
                tsr_match match;
                tsr_match_start(&match, &config, view_of(first), view_of(second), map->data(), map->size(),
                                reinterpret_cast<std::uint8_t *>(scratch->data()), 4 * scratch->size());
                tsr_match_run(&match, UINT16_MAX);
            }};
}

std::vector<Contender> contenders_of(const Case &shape, const cv::Mat &left, const cv::Mat &right)
{
    const auto peer = [&](const std::string &name, const cv::Ptr<cv::StereoMatcher> &matcher) {
        return Contender{name, [=] {
                             cv::Mat disparity;
                             matcher->compute(left, right, disparity);
                         }};
    };
    std::vector<Contender> contenders = {peer("StereoBM", block_matcher(shape.disparities)),
                                         peer("StereoSGBM", semi_global_matcher(shape.disparities))};
    for (unsigned i = 0; tsr_match_kernel_at(i) != nullptr; i++) {
        const bool is_portable = tsr_match_kernel_at(i + 1) == nullptr;
        for (const auto &[mode, name] : {std::pair{TSR_MATCH_SAD, "sad"},
                                         {TSR_MATCH_SAD8, "sad8"},
                                         {TSR_MATCH_CENSUS, "census"},
                                         {TSR_MATCH_SMOOTH, "smooth"}}) {
            if (mode == TSR_MATCH_SAD || !is_portable) {
                contenders.push_back(our_contender(shape, mode, name, tsr_match_kernel_at(i), left, right));
            }
        }
    }
    return contenders;
}

json time_case(const Case &shape, const cv::Mat &left_full, const cv::Mat &right_full)
{
    const std::vector<Contender> contenders =
        contenders_of(shape, reduced(left_full, shape), reduced(right_full, shape));
    std::map<std::string, std::vector<double>> seconds;
    for (int round = 0; round < shape.rounds; round++) {
        for (const Contender &contender : contenders) {
            for (int turn = 0; turn < kTurns; turn++) {
                seconds[contender.name].push_back(seconds_of(contender.run));
            }
        }
    }
    json result = {{"width", shape.width}, {"height", shape.height}, {"disparities", shape.disparities}};
    for (const auto &[name, values] : seconds) {
        result["ms"][name] = 1e3 * median_of(values);
        result["ratio"][name] = median_of(seconds["StereoBM"]) / median_of(values);
    }
    return result;
}

/* Both frames, the map and the scratch. */
json memory_case(const Case &shape)
{
    json result = {{"width", shape.width}, {"height", shape.height}, {"disparities", shape.disparities}};
    for (const auto &[mode, name] : {std::pair{TSR_MATCH_SAD, "sad"},
                                     {TSR_MATCH_CENSUS, "census"},
                                     {TSR_MATCH_SMOOTH, "smooth"},
                                     {TSR_MATCH_RAW, "raw"},
                                     {TSR_MATCH_SSD, "ssd"}}) {
        const tsr_match_config config = options_of(shape, static_cast<std::uint8_t>(mode), {}).match;
        result["bytes"][name] = tsr_match_pair_len(&config) + tsr_match_scratch_len(&config);
    }
    return result;
}

struct Pair {
    cv::Mat left, right, truth;
};

Pair load_pair(const std::filesystem::path &folder, const Case &shape)
{
    const cv::Mat left = cv::imread(folder / "left.png", cv::IMREAD_GRAYSCALE);
    const cv::Mat right = cv::imread(folder / "right.png", cv::IMREAD_GRAYSCALE);
    cv::Mat truth = cv::imread(folder / "gt256_left.png", cv::IMREAD_UNCHANGED);
    const int width = std::min(left.cols, left.rows * 4 / 3);
    const int height = std::min(left.rows, left.cols * 3 / 4);
    const cv::Rect cut((left.cols - width) / 2, (left.rows - height) / 2, width, height);
    truth.convertTo(truth, CV_32F, 1.0 / 256);
    Pair pair{reduced(left(cut), shape), reduced(right(cut), shape), {}};
    cv::resize(truth(cut), pair.truth, {shape.width, shape.height}, 0, 0, cv::INTER_NEAREST);
    pair.truth *= static_cast<double>(shape.width) / width;
    return pair;
}

/* Of disparities in px, negative where there is none: shares of all pixels with truth, but bad ones of the valid. */
json judge(const cv::Mat &disparity, const cv::Mat &truth)
{
    double known = 0, valid = 0, right = 0, close = 0;
    std::vector<double> errors;
    for (int y = 0; y < truth.rows; y++) {
        for (int x = 0; x < truth.cols; x++) {
            const float wanted = truth.at<float>(y, x);
            const float found = disparity.at<float>(y, x);
            known += wanted > 0;
            if (wanted > 0 && found >= 0) {
                const double error = std::abs(found - wanted);
                valid++;
                right += error <= 1;
                close += error <= 0.5;
                errors.push_back(error);
            }
        }
    }
    return {{"correct1", right / known},   {"correct0.5", close / known}, {"bad1", 1 - right / valid},
            {"bad0.5", 1 - close / valid}, {"valid", valid / known},      {"median_error_px", median_of(errors)}};
}

cv::Mat disparities_of(const tsr::StereoOptions &options, const Pair &pair)
{
    tsr::StereoPipeline pipeline(options);
    const auto found = pipeline.run(gray_of(pair.left), gray_of(pair.right));
    cv::Mat disparity(pair.left.rows, pair.left.cols, CV_32F);
    for (std::size_t i = 0; i < found.disparity_q4.size(); i++) {
        const std::uint16_t value = found.disparity_q4[i];
        disparity.at<float>(static_cast<int>(i)) =
            value == TSR_DISPARITY_INVALID ? -1.0F : static_cast<float>(value) / 16;
    }
    return disparity;
}

cv::Mat disparities_of(cv::StereoMatcher &matcher, const Pair &pair)
{
    cv::Mat sixteenths, disparity;
    matcher.compute(pair.left, pair.right, sixteenths);
    sixteenths.convertTo(disparity, CV_32F, 1.0 / 16);
    return disparity;
}

json judge_case(const Case &shape, const std::vector<std::filesystem::path> &folders)
{
    tsr::StereoOptions sad = options_of(shape, TSR_MATCH_SAD, {TSR_REFINE_MEDIAN3, TSR_REFINE_SPECKLE});
    sad.match.uniqueness_percent = 12; /* the speckle filter takes what this lets through */
    const std::map<std::string, tsr::StereoOptions> ours = {
        {"sad", options_of(shape, TSR_MATCH_SAD, {})},
        {"sad refined", sad},
        {"sad8 refined", options_of(shape, TSR_MATCH_SAD8, {TSR_REFINE_MEDIAN3, TSR_REFINE_SPECKLE})},
        {"census refined", options_of(shape, TSR_MATCH_CENSUS, {TSR_REFINE_MEDIAN5, TSR_REFINE_SPECKLE})},
        {"smooth refined", options_of(shape, TSR_MATCH_SMOOTH, {TSR_REFINE_MEDIAN5, TSR_REFINE_SPECKLE})},
        {"smooth dense",
         options_of(shape, TSR_MATCH_SMOOTH, {TSR_REFINE_MEDIAN5, TSR_REFINE_SPECKLE, TSR_REFINE_FILL})}};
    json result = {{"width", shape.width}, {"height", shape.height}, {"disparities", shape.disparities}};
    std::map<std::string, std::map<std::string, double>> sums;
    for (const auto &folder : folders) {
        const Pair pair = load_pair(folder, shape);
        json found;
        for (const auto &[name, options] : ours) {
            found[name] = judge(disparities_of(options, pair), pair.truth);
        }
        found["StereoBM"] = judge(disparities_of(*block_matcher(shape.disparities), pair), pair.truth);
        found["StereoSGBM"] = judge(disparities_of(*semi_global_matcher(shape.disparities), pair), pair.truth);
        for (const auto &[name, values] : found.items()) {
            for (const auto &[key, value] : values.items()) {
                sums[name][key] += value.get<double>() / static_cast<double>(folders.size());
            }
        }
        result["pairs"][folder.filename()] = found;
    }
    result["mean"] = sums;
    return result;
}

} // namespace

int main(int argc, char **argv)
{
    if (argc < 3 || argc > 4) {
        std::fprintf(stderr, "match_peers PICTURE_LEFT PICTURE_RIGHT [FOLDER_OF_PAIRS]\n");
        return 2;
    }
    cv::setNumThreads(1);
    const cv::Mat left = cv::imread(argv[1], cv::IMREAD_GRAYSCALE);
    const cv::Mat right = cv::imread(argv[2], cv::IMREAD_GRAYSCALE);
    if (left.empty() || right.empty()) {
        std::fprintf(stderr, "match_peers: %s: not a picture\n", argv[left.empty() ? 1 : 2]);
        return 2;
    }
    json result = {{"times", json::array()}, {"quality", json::array()}};
    for (const Case &shape : kCases) {
        result["times"].push_back(time_case(shape, left, right));
    }
    for (const Case &shape : kMemoryCases) {
        result["memory"].push_back(memory_case(shape));
    }
    if (argc == 4) {
        std::vector<std::filesystem::path> folders;
        for (const auto &entry : std::filesystem::directory_iterator(argv[3])) {
            if (entry.path().filename().string().starts_with("mb")) {
                folders.push_back(entry.path());
            }
        }
        std::sort(folders.begin(), folders.end());
        for (std::size_t i = 0; i < 2 && !folders.empty(); i++) {
            result["quality"].push_back(judge_case(kCases[i], folders));
        }
    }
    std::printf("%s\n", result.dump(1).c_str());
    return 0;
}

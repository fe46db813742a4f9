/*
 * Two claims of the thesis about time: H1, that matching takes time linear in
 * pixels and disparities, and H2, that sums of absolute differences are faster
 * than sums of squared ones. JSON: milliseconds of modes raw, ssd and sad in the
 * portable kernel, and of sad in the fastest one, over sizes and disparities.
 *
 *   match_claims PICTURE_LEFT PICTURE_RIGHT
 *
 * The least of rounds in which every mode runs once, in one thread, after one that
 * is not counted: what other work on the machine takes away only adds.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tsr/stereo/stereo_pipeline.h"

namespace
{

using nlohmann::json;

constexpr int kRounds = 15;
const cv::Size kSizes[] = {{160, 120}, {240, 180}, {320, 240}, {480, 360}, {640, 480}};
constexpr int kDisparities[] = {16, 32, 64, 96, 128};

tsr::GrayImage reduced(const cv::Mat &picture, cv::Size size)
{
    cv::Mat small;
    cv::resize(picture, small, size, 0, 0, cv::INTER_AREA);
    tsr::GrayImage image;
    image.width = static_cast<std::uint16_t>(size.width);
    image.height = static_cast<std::uint16_t>(size.height);
    image.pixels.assign(small.datastart, small.dataend);
    return image;
}

const tsr_match_kernel *portable_kernel()
{
    unsigned last = 0;
    while (tsr_match_kernel_at(last + 1) != nullptr) {
        last++;
    }
    return tsr_match_kernel_at(last);
}

struct Run {
    const char *name;
    tsr_match_mode mode;
    const tsr_match_kernel *kernel;
};

json time_case(cv::Size size, int disparities, const cv::Mat &left_full, const cv::Mat &right_full)
{
    const tsr::GrayImage left = reduced(left_full, size);
    const tsr::GrayImage right = reduced(right_full, size);
    const Run runs[] = {{"raw", TSR_MATCH_RAW, portable_kernel()},
                        {"ssd", TSR_MATCH_SSD, portable_kernel()},
                        {"sad", TSR_MATCH_SAD, portable_kernel()},
                        {"sad, fastest kernel", TSR_MATCH_SAD, tsr_match_kernel_at(0)}};
    std::map<std::string, std::vector<double>> times_ms;
    for (int round = -1; round < kRounds; round++) {
        for (const Run &run : runs) {
            tsr::StereoOptions options;
            options.match.width = left.width;
            options.match.height = left.height;
            options.match.disparities = static_cast<std::uint16_t>(disparities);
            options.match.mode = static_cast<std::uint8_t>(run.mode);
            options.match.kernel = run.kernel;
            const double time_ms = tsr::StereoPipeline(options).run(left, right).match_ms;
            if (round >= 0) {
                times_ms[run.name].push_back(time_ms);
            }
        }
    }
    json result = {{"width", size.width}, {"height", size.height}, {"disparities", disparities}};
    for (const auto &[name, values] : times_ms) {
        result["ms"][name] = *std::min_element(values.begin(), values.end());
    }
    return result;
}

} // namespace

int main(int argc, char **argv)
{
    if (argc != 3) {
        std::fprintf(stderr, "match_claims PICTURE_LEFT PICTURE_RIGHT\n");
        return 2;
    }
    const cv::Mat left = cv::imread(argv[1], cv::IMREAD_GRAYSCALE);
    const cv::Mat right = cv::imread(argv[2], cv::IMREAD_GRAYSCALE);
    if (left.empty() || right.empty()) {
        std::fprintf(stderr, "match_claims: %s: not a picture\n", argv[left.empty() ? 1 : 2]);
        return 2;
    }
    cv::setNumThreads(1);
    json result = json::array();
    for (const cv::Size size : kSizes) {
        for (const int disparities : kDisparities) {
            result.push_back(time_case(size, disparities, left, right));
        }
    }
    std::printf("%s\n", result.dump(1).c_str());
    return 0;
}

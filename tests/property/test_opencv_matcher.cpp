// The matcher beside OpenCV's StereoBM, its peer: same window, prefilter, disparities and left-right tolerance, on the
// Aloe pair of Debian's opencv-doc (Scharstein & Pal 2007; ground truth in px of the full-size pair), cut to 4:3 and
// reduced to 160x120. Ours matches the borders that StereoBM leaves out, so it must be right on more pixels, and hardly
// more often wrong on those it calls valid.
//
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

extern "C" {
#include "tsr/vision/match.h"
}

namespace
{

const std::filesystem::path kFolder = "/usr/share/doc/opencv-doc/examples/data";
constexpr int kWidth = 160;
constexpr int kHeight = 120;
constexpr int kDisparities = 32;
constexpr int kWindow = 9;
constexpr int kCap = 7;
constexpr int kPeerCap = 14; // of its sums, which are wider
constexpr int kUniquenessPercent = 15;
// With OpenCV 4.6 ours is lower by 0.023, although it is judged on the borders as well.
constexpr double kBad1Margin = 0.01;

struct Pair {
    cv::Mat left;
    cv::Mat right;
    cv::Mat truth; // CV_32F, px at 160x120, 0 unknown
};

cv::Mat cut_to_4_3(const cv::Mat &picture)
{
    const int width = std::min(picture.cols, picture.rows * 4 / 3);
    const int height = std::min(picture.rows, picture.cols * 3 / 4);
    return picture(cv::Rect((picture.cols - width) / 2, (picture.rows - height) / 2, width, height));
}

Pair load_aloe()
{
    const cv::Mat left = cut_to_4_3(cv::imread((kFolder / "aloeL.jpg").string(), cv::IMREAD_GRAYSCALE));
    const cv::Mat right = cut_to_4_3(cv::imread((kFolder / "aloeR.jpg").string(), cv::IMREAD_GRAYSCALE));
    const cv::Mat truth = cut_to_4_3(cv::imread((kFolder / "aloeGT.png").string(), cv::IMREAD_GRAYSCALE));
    const cv::Size size(kWidth, kHeight);
    Pair pair;
    cv::resize(left, pair.left, size, 0, 0, cv::INTER_AREA);
    cv::resize(right, pair.right, size, 0, 0, cv::INTER_AREA);
    cv::resize(truth, pair.truth, size, 0, 0, cv::INTER_NEAREST);
    pair.truth.convertTo(pair.truth, CV_32F, static_cast<double>(kWidth) / truth.cols);
    return pair;
}

// CV_32F, px, negative = no match
cv::Mat match_ours(const Pair &pair)
{
    tsr_match_config config = {};
    config.width = kWidth;
    config.height = kHeight;
    config.disparities = kDisparities;
    config.window = kWindow;
    config.prefilter_cap = kCap;
    config.uniqueness_percent = kUniquenessPercent;
    cv::Mat left = pair.left.clone();
    cv::Mat right = pair.right.clone();
    cv::Mat map(kHeight, kWidth, CV_16U);
    std::vector<std::uint32_t> scratch(tsr_match_scratch_len(&config) / sizeof(std::uint32_t) + 1);
    tsr_match match;
    EXPECT_EQ(tsr_match_start(&match, &config, {left.data, kWidth, kHeight, kWidth},
                              {right.data, kWidth, kHeight, kWidth}, map.ptr<std::uint16_t>(), map.total(),
                              reinterpret_cast<std::uint8_t *>(scratch.data()), 4 * scratch.size()),
              TSR_OK);
    EXPECT_EQ(tsr_match_run(&match, UINT16_MAX), TSR_OK);
    cv::Mat disparity;
    map.convertTo(disparity, CV_32F, 1.0 / TSR_DISPARITY_ONE_Q4);
    disparity.setTo(-1, map == TSR_DISPARITY_INVALID);
    return disparity;
}

cv::Mat match_peer(const Pair &pair)
{
    const auto peer = cv::StereoBM::create(kDisparities, kWindow);
    peer->setPreFilterType(cv::StereoBM::PREFILTER_XSOBEL);
    peer->setPreFilterCap(kPeerCap);
    peer->setUniquenessRatio(kUniquenessPercent);
    peer->setTextureThreshold(kWindow);
    peer->setDisp12MaxDiff(1);
    cv::Mat fixed;
    cv::Mat disparity;
    peer->compute(pair.left, pair.right, fixed);
    fixed.convertTo(disparity, CV_32F, 1.0 / 16);
    return disparity;
}

struct Quality {
    double correct;      // within 1 px, of all pixels with ground truth
    double bad1;         // not so, of the valid ones
    double median_error; // px, of the valid ones
};

Quality judge(const cv::Mat &disparity, const cv::Mat &truth)
{
    int known = 0;
    std::vector<double> errors;
    for (int y = 0; y < kHeight; y++) {
        for (int x = 0; x < kWidth; x++) {
            if (truth.at<float>(y, x) <= 0) {
                continue;
            }
            known++;
            if (disparity.at<float>(y, x) >= 0) {
                errors.push_back(std::abs(disparity.at<float>(y, x) - truth.at<float>(y, x)));
            }
        }
    }
    std::sort(errors.begin(), errors.end());
    const auto right = static_cast<double>(std::upper_bound(errors.begin(), errors.end(), 1.0) - errors.begin());
    const auto valid = static_cast<double>(errors.size());
    return {right / known, 1 - right / valid, errors[errors.size() / 2]};
}

std::string describe(const Quality &quality)
{
    return "correct " + std::to_string(quality.correct) + ", bad1 " + std::to_string(quality.bad1) + ", median error " +
           std::to_string(quality.median_error) + " px";
}

TEST(OpencvMatcher, IsRightOnMorePixelsThanStereoBm)
{
    for (const char *name : {"aloeL.jpg", "aloeR.jpg", "aloeGT.png"}) {
        if (!std::filesystem::exists(kFolder / name)) {
            GTEST_SKIP() << name << " is not installed (Debian: opencv-doc)";
        }
    }
    const Pair pair = load_aloe();
    const Quality ours = judge(match_ours(pair), pair.truth);
    const Quality peer = judge(match_peer(pair), pair.truth);
    std::cout << "ours: " << describe(ours) << "\npeer: " << describe(peer) << "\n";
    EXPECT_GT(ours.correct, peer.correct);
    EXPECT_LE(ours.bad1, peer.bad1 + kBad1Margin);
    EXPECT_LE(ours.median_error, 0.4);
}

} // namespace

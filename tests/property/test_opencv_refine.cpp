// Speckle removal beside OpenCV's filterSpeckles, and the 3x3 and 5x5 median and Gaussian of a map without holes beside
// medianBlur and a filter with the same kernel: the same pixels, on random maps.
//
// Replay: SEED=n.
//
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

extern "C" {
#include "tsr/vision/refine.h"
}

namespace
{

constexpr int kCases = 600;

class OpencvRefine : public testing::Test
{
  protected:
    void SetUp() override
    {
        const char *text = std::getenv("SEED");
        const unsigned seed = text != nullptr ? static_cast<unsigned>(std::atoi(text)) : 1;
        std::cout << "replay: SEED=" << seed << " property_test_opencv_refine\n";
        random_.seed(seed);
    }

    int below(int bound) { return static_cast<int>(random_() % static_cast<unsigned>(bound)); }

    // CV_16U, UQ12.4: noise, planes with steps, or both, with holes.
    cv::Mat draw_map(int width, int height, int holes_of_10)
    {
        cv::Mat map(height, width, CV_16U);
        const int noise = 1 + below(60);
        const int slope = below(20);
        for (int y = 0; y < height; y++) {
            for (int x = 0; x < width; x++) {
                const int step = (x / 7 + y / 5) % 3 * 60;
                const bool hole = below(10) < holes_of_10;
                map.at<std::uint16_t>(y, x) =
                    hole ? TSR_DISPARITY_INVALID : static_cast<std::uint16_t>(below(noise) + slope * x / 8 + step);
            }
        }
        return map;
    }

    static cv::Mat refine(const cv::Mat &before, tsr_refine_step step, const tsr_speckle_config &speckle = {})
    {
        tsr_refine_config config = {};
        config.width = static_cast<std::uint16_t>(before.cols);
        config.height = static_cast<std::uint16_t>(before.rows);
        config.steps[0] = static_cast<std::uint8_t>(step);
        config.speckle = speckle;
        cv::Mat map = before.clone();
        std::vector<std::uint16_t> scratch(tsr_refine_scratch_len(&config) / 2 + 1);
        tsr_refine work;
        EXPECT_EQ(tsr_refine_start(&work, &config, map.ptr<std::uint16_t>(), map.total(),
                                   reinterpret_cast<std::uint8_t *>(scratch.data()), 2 * scratch.size()),
                  TSR_OK);
        while (tsr_refine_run(&work, 3) == TSR_AGAIN) {
        }
        return map;
    }

    static std::string describe(const cv::Mat &map, int i)
    {
        return "case " + std::to_string(i) + ", " + std::to_string(map.cols) + "x" + std::to_string(map.rows);
    }

    std::mt19937 random_;
};

TEST_F(OpencvRefine, SpecklesAreThoseOfFilterSpeckles)
{
    constexpr std::int16_t kPeerInvalid = -1;
    int removed = 0;
    for (int i = 0; i < kCases; i++) {
        const cv::Mat before = draw_map(1 + below(90), 1 + below(60), below(7));
        tsr_speckle_config config = {};
        config.min_size = static_cast<std::uint16_t>(2 + below(i % 3 == 0 ? 600 : 60));
        config.max_difference_q4 = static_cast<std::uint16_t>(1 + below(40));
        cv::Mat peer;
        before.convertTo(peer, CV_16S);
        peer.setTo(kPeerInvalid, before == TSR_DISPARITY_INVALID);
        cv::filterSpeckles(peer, kPeerInvalid, config.min_size - 1, config.max_difference_q4);
        const cv::Mat ours = refine(before, TSR_REFINE_SPECKLE, config);
        cv::Mat wanted;
        peer.convertTo(wanted, CV_16U);
        wanted.setTo(TSR_DISPARITY_INVALID, peer == kPeerInvalid);
        ASSERT_EQ(cv::countNonZero(ours != wanted), 0) << describe(before, i);
        removed += cv::countNonZero(ours != before);
    }
    EXPECT_GT(removed, kCases);
}

TEST_F(OpencvRefine, MedianAndGaussianWithoutHolesAreOpencvsInside)
{
    for (int i = 0; i < kCases; i++) {
        const cv::Mat before = draw_map(7 + below(60), 7 + below(40), 0);
        for (const int window : {3, 5}) {
            const cv::Rect inside(window / 2, window / 2, before.cols - window + 1, before.rows - window + 1);
            cv::Mat median;
            cv::medianBlur(before, median, window);
            const cv::Mat ours = refine(before, window == 3 ? TSR_REFINE_MEDIAN3 : TSR_REFINE_MEDIAN5);
            ASSERT_EQ(cv::countNonZero(ours(inside) != median(inside)), 0) << describe(before, i);

            const cv::Mat kernel =
                window == 3 ? (cv::Mat_<double>(3, 1) << 1, 2, 1) / 4 : (cv::Mat_<double>(5, 1) << 1, 4, 6, 4, 1) / 16;
            cv::Mat smooth;
            cv::sepFilter2D(before, smooth, CV_64F, kernel, kernel);
            const cv::Mat rounded = refine(before, window == 3 ? TSR_REFINE_GAUSSIAN3 : TSR_REFINE_GAUSSIAN5);
            for (int y = inside.y; y < inside.y + inside.height; y++) {
                for (int x = inside.x; x < inside.x + inside.width; x++) {
                    ASSERT_EQ(rounded.at<std::uint16_t>(y, x), std::floor(smooth.at<double>(y, x) + 0.5))
                        << describe(before, i) << " at " << x << " " << y;
                }
            }
        }
    }
}

} // namespace

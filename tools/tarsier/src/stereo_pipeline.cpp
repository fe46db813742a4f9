/*
 * Matching and filtering in one go.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/stereo/stereo_pipeline.h"

#include <chrono>
#include <stdexcept>

namespace tsr
{
namespace
{

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point begin)
{
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

StereoOptions with_one_size(StereoOptions options)
{
    options.refine.width = options.match.width;
    options.refine.height = options.match.height;
    return options;
}

/* The firmware refused what bad_field() let pass: a defect. */
void expect(tsr_status status, const char *what)
{
    if (status != TSR_OK) {
        throw std::logic_error(std::string(what) + ": " + tsr_status_name(status));
    }
}

tsr_gray whole(GrayImage &image)
{
    const auto width = static_cast<std::uint16_t>(image.width);
    return {image.pixels.data(), width, static_cast<std::uint16_t>(image.height), width};
}

} // namespace

std::string StereoPipeline::bad_field(const StereoOptions &options)
{
    const StereoOptions sized = with_one_size(options);
    const char *field = "";
    if (tsr_match_check(&sized.match, &field) == TSR_OK) {
        (void)tsr_refine_check(&sized.refine, &field);
    }
    return field;
}

StereoPipeline::StereoPipeline(const StereoOptions &options) : options_(with_one_size(options))
{
    if (const std::string field = bad_field(options); !field.empty()) {
        throw std::invalid_argument("StereoPipeline: " + field);
    }
    match_scratch_len_ = tsr_match_scratch_len(&options_.match);
    match_scratch_.resize((match_scratch_len_ + sizeof(std::uint32_t) - 1) / sizeof(std::uint32_t));
    refine_scratch_len_ = tsr_refine_scratch_len(&options_.refine);
    refine_scratch_.resize((refine_scratch_len_ + 1) / sizeof(std::uint16_t));
}

StereoResult StereoPipeline::run(const GrayImage &left, const GrayImage &right)
{
    const ImageSize size{options_.match.width, options_.match.height};
    if (left.size() != size || right.size() != size) {
        throw std::invalid_argument("StereoPipeline: a picture of another size");
    }
    GrayImage left_frame = left; /* the matcher consumes its frames */
    GrayImage right_frame = right;
    StereoResult result;
    result.disparity_q4.resize(left.pixels.size());
    std::uint16_t *map = result.disparity_q4.data();
    const std::size_t count = result.disparity_q4.size();

    const auto match_begin = Clock::now();
    expect(tsr_match_start(&match_, &options_.match, whole(left_frame), whole(right_frame), map, count,
                           reinterpret_cast<std::uint8_t *>(match_scratch_.data()), match_scratch_len_),
           "tsr_match_start");
    while (tsr_match_run(&match_, UINT16_MAX) == TSR_AGAIN) {
    }
    result.match_ms = milliseconds_since(match_begin);

    const auto refine_begin = Clock::now();
    expect(tsr_refine_start(&refine_, &options_.refine, map, count,
                            reinterpret_cast<std::uint8_t *>(refine_scratch_.data()), refine_scratch_len_),
           "tsr_refine_start");
    while (tsr_refine_run(&refine_, UINT16_MAX) == TSR_AGAIN) {
    }
    result.refine_ms = milliseconds_since(refine_begin);
    return result;
}

} // namespace tsr

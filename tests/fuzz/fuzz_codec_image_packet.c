/*
 * Any bytes as a packet of a gray image, a view or a picture: nothing but its own pixels change, and what is said to
 * have come has.
 *
 *   tools/fuzz codec_image_packet
 *
 * The first five bytes choose the codec, width, height, its option (near; cap, coarse; step) and the id.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "tsr/codec/gray_packet.h"
#include "tsr/codec/picture_packet.h"
#include "tsr/codec/view_packet.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len);

#define IMAGE_CHOICES_LEN 5u
#define IMAGE_WIDTH_MAX 80u
#define IMAGE_HEIGHT_MAX 64u
#define IMAGE_PIXELS_MAX (IMAGE_WIDTH_MAX * IMAGE_HEIGHT_MAX)
#define IMAGE_UNTOUCHED 0x5a

static uint8_t fuzz_image[IMAGE_PIXELS_MAX];
static uint8_t fuzz_image_smoothed[IMAGE_PIXELS_MAX];
static uint8_t fuzz_image_marks[TSR_PACKET_ARRIVED_LEN(IMAGE_WIDTH_MAX, IMAGE_HEIGHT_MAX)];

static void require_image(int condition)
{
    if (!condition) {
        abort();
    }
}

/* A packet and what to make of it. */
struct fuzz_image_choice {
    uint16_t width, height;
    uint8_t option, id;
    const uint8_t *bytes;
    size_t len;
};

static bool has_come(const struct fuzz_image_choice *choice, unsigned x, unsigned y)
{
    return tsr_packets_have(fuzz_image_marks, choice->width, choice->height, (uint16_t)x, (uint16_t)y);
}

/* Largest pixel, units and missing ones. */
struct fuzz_image_result {
    enum tsr_status status;
    unsigned pixel_max;
    size_t units, missing;
    struct tsr_packet packet;
};

static struct fuzz_image_result fuzz_gray_packet(const struct fuzz_image_choice *choice)
{
    static struct tsr_gray_packet_state state;
    const struct tsr_gray_info info = {choice->width, choice->height,
                                       choice->option % (TSR_GRAY_NEAR_BY_ACTIVITY + 1u)};
    struct fuzz_image_result result = {.pixel_max = 255, .units = (size_t)info.width * info.height};
    result.status =
        tsr_gray_packet_decode(&state, &info, choice->id, choice->bytes, choice->len, &result.packet, fuzz_image,
                               info.width, fuzz_image_marks, TSR_PACKET_ARRIVED_LEN(info.width, info.height));
    result.missing = tsr_packets_missing(fuzz_image_marks, info.width, info.height);
    return result;
}

static struct fuzz_image_result fuzz_view_packet(const struct fuzz_image_choice *choice)
{
    static struct tsr_view_packet_state state;
    struct tsr_view_info info = {choice->width, choice->height, 1u + choice->option % TSR_VIEW_CAP_MAX, false, false};
    info.coarse = info.cap == TSR_VIEW_CAP_MAX && choice->option >= 128;
    struct fuzz_image_result result = {.pixel_max = 2u * info.cap, .units = (size_t)info.width * info.height};
    result.status =
        tsr_view_packet_decode(&state, &info, choice->id, choice->bytes, choice->len, &result.packet, fuzz_image,
                               info.width, fuzz_image_marks, TSR_PACKET_ARRIVED_LEN(info.width, info.height));
    result.missing = tsr_packets_missing(fuzz_image_marks, info.width, info.height);
    return result;
}

static struct fuzz_image_result fuzz_picture_packet(const struct fuzz_image_choice *choice)
{
    static struct tsr_picture_packet_state state;
    const struct tsr_picture_info info = {choice->width, choice->height, choice->option % (TSR_PICTURE_STEP_MAX + 1u),
                                          TSR_PICTURE_PRIOR_TRAINED};
    const size_t units = TSR_PICTURE_MARKS_LEN(info.width, info.height);
    struct fuzz_image_result result = {.pixel_max = 255, .units = units};
    result.status = tsr_picture_packet_decode(&state, &info, choice->id, choice->bytes, choice->len, &result.packet,
                                              fuzz_image, info.width, fuzz_image_marks, units);
    result.missing = tsr_picture_packets_missing(&info, fuzz_image_marks);
    require_image(tsr_picture_packets_smooth(&info, fuzz_image, info.width, fuzz_image_marks, fuzz_image_smoothed,
                                             info.width) == TSR_OK);
    return result;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len)
{
    if (len < IMAGE_CHOICES_LEN) {
        return 0;
    }
    const unsigned codec = bytes[0] % 3u;
    const struct fuzz_image_choice choice = {.width = (uint16_t)(1u + bytes[1] % IMAGE_WIDTH_MAX),
                                             .height = (uint16_t)(1u + bytes[2] % IMAGE_HEIGHT_MAX),
                                             .option = bytes[3],
                                             .id = bytes[4] % (TSR_PACKET_ID_MAX + 1u),
                                             .bytes = bytes + IMAGE_CHOICES_LEN,
                                             .len = len - IMAGE_CHOICES_LEN};
    memset(fuzz_image, IMAGE_UNTOUCHED, sizeof fuzz_image);
    memset(fuzz_image_marks, 0, sizeof fuzz_image_marks);
    const struct fuzz_image_result result = codec == 0   ? fuzz_gray_packet(&choice)
                                            : codec == 1 ? fuzz_view_packet(&choice)
                                                         : fuzz_picture_packet(&choice);
    const size_t count = result.status == TSR_OK ? result.packet.count : 0;
    require_image(result.status == TSR_OK || result.status == TSR_ERR_FORMAT || result.status == TSR_ERR_VERSION ||
                  result.status == TSR_ERR_NOREF);
    require_image(result.missing == result.units - count);
    require_image(count == 0 || result.packet.first + count <= result.units);
    for (unsigned i = 0; i < IMAGE_PIXELS_MAX; i++) {
        const unsigned x = i % choice.width, y = i / choice.width;
        const bool inside = y < choice.height;
        const bool come = inside && (codec < 2 ? has_come(&choice, x, y)
                                               : fuzz_image_marks[y / 8u * ((choice.width + 7u) / 8u) + x / 8u] != 0);
        require_image(come ? fuzz_image[i] <= result.pixel_max : fuzz_image[i] == IMAGE_UNTOUCHED);
    }
    return 0;
}

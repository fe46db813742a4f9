/*
 * Gray images in packets: each decodes alone and in any order, within near; what is lost loses its own pixels and no
 * others; no packet outgrows its size, whatever the image holds.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "codec_content.h"
#include "tsr/codec/gray_packet.h"

#define PACKETS(name) tsr_gray_##name
#define PACKETS_MARKS_LEN(width, height) TSR_PACKET_ARRIVED_LEN(width, height)
#define PACKETS_MISSING(info, marks) tsr_packets_missing(marks, (info)->width, (info)->height)
#define PACKETS_UNITS(info) ((uint32_t)(info)->width * (info)->height)
#define PACKETS_HAVE(info, marks, x, y) tsr_packets_have(marks, (info)->width, (info)->height, x, y)
#include "codec_packets_property.h"

static struct tsr_gray_info draw_info(struct codec_random *random)
{
    return (struct tsr_gray_info){.width = (uint16_t)(1 + codec_random_below(random, 100)),
                                  .height = (uint16_t)(1 + codec_random_below(random, 80)),
                                  .near = (uint8_t)codec_random_below(random, TSR_GRAY_NEAR_BY_ACTIVITY + 1)};
}

static uint8_t draw_pixel(struct codec_random *random, unsigned content, unsigned x, unsigned y)
{
    return pick(random, (enum content)(content % CONTENT_COUNT), x, y);
}

static unsigned expect(const struct tsr_gray_info *info, size_t stride, uint8_t id, unsigned count)
{
    (void)stride, (void)id, (void)count;
    memcpy(expected, image, sizeof expected);
    return info->near == TSR_GRAY_NEAR_BY_ACTIVITY ? TSR_GRAY_NEAR_BY_ACTIVITY_MAX : info->near;
}

int main(int argc, char **argv)
{
    program = argc > 0 ? argv[0] : "";
    UNITY_BEGIN();
    RUN_TEST(test_random_images);
    RUN_TEST(test_damaged_packets);
    return UNITY_END();
}

/*
 * Prefiltered views in packets: each decodes alone and in any order, exactly or coarsely; what is lost loses its own
 * pixels and no others; no packet outgrows its size, whatever the view holds.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "codec_content.h"
#include "tsr/codec/view_packet.h"

#define PACKETS(name) tsr_view_##name
#define PACKETS_MARKS_LEN(width, height) TSR_PACKET_ARRIVED_LEN(width, height)
#define PACKETS_MISSING(info, marks) tsr_packets_missing(marks, (info)->width, (info)->height)
#define PACKETS_UNITS(info) ((uint32_t)(info)->width * (info)->height)
#define PACKETS_HAVE(info, marks, x, y) tsr_packets_have(marks, (info)->width, (info)->height, x, y)
#include "codec_packets_property.h"

static struct tsr_view_info draw_info(struct codec_random *random)
{
    const uint8_t cap = (uint8_t)(codec_random_below(random, 2) == 0 ? 7 : 1 + codec_random_below(random, 7));
    return (struct tsr_view_info){.width = (uint16_t)(1 + codec_random_below(random, PACKETS_WIDTH_MAX)),
                                  .height = (uint16_t)(1 + codec_random_below(random, PACKETS_HEIGHT_MAX)),
                                  .cap = cap,
                                  .coarse = cap == 7 && codec_random_below(random, 2) == 0};
}

/* Waves, noise, and what gray images hold. */
static uint8_t draw_pixel(struct codec_random *random, unsigned content, unsigned x, unsigned y)
{
    if (content >= 8) {
        return (uint8_t)((x * x / 16 + y / 4) % 13 + codec_random_below(random, content - 7));
    }
    return content >= CONTENT_COUNT ? 7 : pick(random, (enum content)content, x, y);
}

static unsigned expect(const struct tsr_view_info *info, size_t stride, uint8_t id, unsigned count)
{
    static const uint8_t coarse[15] = {0, 0, 3, 3, 5, 5, 6, 7, 8, 9, 9, 11, 11, 14, 14};
    (void)stride, (void)id, (void)count;
    for (size_t i = 0; i < sizeof expected; i++) {
        const uint8_t cut = image[i] < 2 * info->cap ? image[i] : (uint8_t)(2 * info->cap);
        expected[i] = info->coarse ? coarse[cut] : cut;
    }
    return 0;
}

int main(int argc, char **argv)
{
    program = argc > 0 ? argv[0] : "";
    UNITY_BEGIN();
    RUN_TEST(test_random_images);
    RUN_TEST(test_damaged_packets);
    return UNITY_END();
}

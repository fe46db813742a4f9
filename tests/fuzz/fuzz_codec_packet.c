/*
 * Any bytes as a packet of a map: nothing but its own pixels change, and every value is one of the map's.
 *
 *   tools/fuzz codec_packet
 *
 * The first five bytes choose the map: width, height, disparities, step and map id.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "tsr/codec/map_packet.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len);

#define PACKET_CHOICES_LEN 5u
#define PACKET_WIDTH_MAX 80u
#define PACKET_HEIGHT_MAX 64u

static uint16_t fuzz_packet_map[PACKET_WIDTH_MAX * PACKET_HEIGHT_MAX];
static uint16_t fuzz_packet_scratch[TSR_MAP_PACKET_SCRATCH_COUNT];
static struct tsr_map_model fuzz_packet_model;

static void require_packet(int condition)
{
    if (!condition) {
        abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len)
{
    if (len < PACKET_CHOICES_LEN) {
        return 0;
    }
    const struct tsr_map_info info = {.width = (uint16_t)(1u + bytes[0] % PACKET_WIDTH_MAX),
                                      .height = (uint16_t)(1u + bytes[1] % PACKET_HEIGHT_MAX),
                                      .disparities = (uint16_t)(1u + bytes[2] % TSR_DISPARITY_COUNT_MAX),
                                      .step_log2 = bytes[3] % (TSR_MAP_STEP_LOG2_MAX + 1u),
                                      .near = bytes[3] >> 7};
    const size_t pixels = (size_t)info.width * info.height;
    struct tsr_map_packet packet = {.count = 0};
    require_packet(tsr_map_packets_clear(&info, fuzz_packet_map, info.width) == TSR_OK);
    const enum tsr_status status =
        tsr_map_packet_decode(&fuzz_packet_model, &info, bytes[4] % (TSR_MAP_PACKET_MAP_ID_MAX + 1u),
                              bytes + PACKET_CHOICES_LEN, len - PACKET_CHOICES_LEN, fuzz_packet_scratch,
                              TSR_MAP_PACKET_SCRATCH_COUNT, &packet, fuzz_packet_map, info.width);
    require_packet(status == TSR_OK || status == TSR_ERR_FORMAT || status == TSR_ERR_VERSION ||
                   status == TSR_ERR_NOREF);
    require_packet(packet.first + (size_t)packet.count <= pixels || packet.count == 0);
    require_packet(tsr_map_packets_missing(&info, fuzz_packet_map, info.width) == pixels - packet.count);
    for (size_t i = 0; i < pixels; i++) {
        const unsigned value = fuzz_packet_map[i];
        require_packet(value == TSR_DISPARITY_INVALID || value == TSR_MAP_PIXEL_MISSING ||
                       (value < info.disparities * 16u && value % (1u << info.step_log2) == 0));
    }
    return 0;
}

/*
 * Magnitudes in buckets, docs/codec.md, 1.5.
 *
 *   magnitude   0 1 2 3 | 4 5 | 6..9 | 10..17 | ... | 1026..2049
 *   bucket      0 1 2 3 |  4  |   5  |    6   | ... |     13
 *   place, bits         |  1  |   2  |    3   | ... |     10
 *
 * The place's first bit is adaptive, the others are equally likely.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "range_port.h"

uint32_t tsr_port_magnitude(const struct tsr_range_port *port,
                            struct tsr_range_bit contexts[TSR_MAGNITUDE_CONTEXT_COUNT], uint32_t magnitude)
{
    const unsigned target = tsr_magnitude_bucket(magnitude);
    unsigned bucket = 0;
    while (bucket < TSR_MAGNITUDE_BUCKET_LAST && tsr_port_bit(port, &contexts[bucket], target > bucket)) {
        bucket++;
    }
    if (bucket < TSR_MAGNITUDE_SINGLES) {
        return bucket;
    }
    const unsigned rest_bits = bucket - TSR_MAGNITUDE_SINGLES;
    const uint32_t first = (2u << rest_bits) + 2u;
    const uint32_t place = magnitude - first;
    struct tsr_range_bit *const half = &contexts[TSR_MAGNITUDE_BUCKET_LAST + rest_bits];
    const uint32_t upper = tsr_port_bit(port, half, (place >> rest_bits & 1u) != 0);
    const uint32_t rest = rest_bits > 0 ? tsr_port_direct(port, place & ((1u << rest_bits) - 1u), rest_bits) : 0;
    return first + (upper << rest_bits) + rest;
}

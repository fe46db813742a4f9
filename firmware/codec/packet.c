/*
 * Packets that decode alone: header, geometry, filling.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "packet.h"

#include "tsr/base/bytes.h"

#define COUNT_BITS 9u
#define LITERAL_AT 26u
#define ID_AT 27u
#define VERSION_AT 30u

struct tsr_packet_place tsr_packet_place_of(const struct tsr_packet_grid *grid, uint32_t position)
{
    const uint32_t strip_units = (uint32_t)grid->strip_width * grid->height;
    const unsigned strip_x = position / strip_units * grid->strip_width;
    const unsigned left = grid->width - strip_x;
    const unsigned strip_width = left < grid->strip_width ? left : grid->strip_width;
    const uint32_t within = position % strip_units;
    return (struct tsr_packet_place){strip_x, strip_width, within % strip_width, within / strip_width};
}

void tsr_packet_write_header(uint8_t out[TSR_PACKET_HEADER_LEN], const struct tsr_packet_grid *grid, unsigned version,
                             const struct tsr_packet *packet)
{
    struct tsr_writer writer = tsr_writer_make(out, TSR_PACKET_HEADER_LEN);
    tsr_write_u32(&writer, packet->first / grid->group | (uint32_t)packet->coarser << grid->first_bits |
                               ((packet->count - 1u) / grid->group) << TSR_PACKET_FIRST_BITS |
                               (uint32_t)packet->is_literal << LITERAL_AT | (uint32_t)packet->id << ID_AT |
                               (uint32_t)version << VERSION_AT);
}

enum tsr_status tsr_packet_read_header(const uint8_t *bytes, size_t len, const struct tsr_packet_grid *grid,
                                       unsigned version, unsigned id, struct tsr_packet *packet)
{
    if (len < TSR_PACKET_HEADER_LEN) {
        return TSR_ERR_FORMAT;
    }
    struct tsr_reader reader = tsr_reader_make(bytes, TSR_PACKET_HEADER_LEN);
    const uint32_t word = tsr_read_u32(&reader);
    if (word >> VERSION_AT != version) {
        return TSR_ERR_VERSION;
    }
    const uint32_t first_field = word & ((1u << TSR_PACKET_FIRST_BITS) - 1u);
    struct tsr_packet read = {.id = (uint8_t)(word >> ID_AT & TSR_PACKET_ID_MAX),
                              .coarser = (uint8_t)(first_field >> grid->first_bits),
                              .is_literal = (word >> LITERAL_AT & 1u) != 0,
                              .first = (first_field & ((1u << grid->first_bits) - 1u)) * grid->group};
    read.count = ((word >> TSR_PACKET_FIRST_BITS & ((1u << COUNT_BITS) - 1u)) + 1u) * grid->group;
    const uint32_t units = tsr_packet_units(grid);
    if (read.first >= units || read.count >= units - read.first + grid->group) {
        return TSR_ERR_FORMAT;
    }
    read.count = read.count < units - read.first ? read.count : units - read.first;
    if (read.id != id) {
        return TSR_ERR_NOREF;
    }
    *packet = read;
    return TSR_OK;
}

enum tsr_status tsr_packet_source_start(struct tsr_packet_source *source, const uint8_t *pixels, size_t stride,
                                        uint16_t width, uint16_t height, uint8_t id)
{
    if (id > TSR_PACKET_ID_MAX) {
        return TSR_ERR_ARG;
    }
    if (stride < width) {
        return TSR_ERR_SIZE;
    }
    *source = (struct tsr_packet_source){pixels, stride, width, height, id, 0};
    return TSR_OK;
}

enum tsr_status tsr_packet_check_next(const struct tsr_packet_source *source, const struct tsr_packet_grid *grid,
                                      size_t out_cap)
{
    if (out_cap < TSR_PACKET_LEN_MIN) {
        return TSR_ERR_NOBUF;
    }
    return source->position < tsr_packet_units(grid) ? TSR_OK : TSR_ERR_SIZE;
}

enum tsr_status tsr_packet_finish(struct tsr_packet_source *source, const struct tsr_packet_grid *grid,
                                  struct tsr_range_encoder *range, unsigned version, const struct tsr_packet *packet,
                                  uint8_t *out, size_t *len)
{
    size_t payload_len = 0;
    const enum tsr_status status = tsr_range_encode_finish(range, &payload_len);
    if (status != TSR_OK) {
        return status;
    }
    tsr_packet_write_header(out, grid, version, packet);
    source->position += packet->count;
    *len = TSR_PACKET_HEADER_LEN + payload_len;
    return source->position < tsr_packet_units(grid) ? TSR_AGAIN : TSR_OK;
}

/* Would the stream end within its buffer? */
static bool would_fit(struct tsr_range_encoder range)
{
    uint8_t spare[TSR_RANGE_FINISH_LEN_MAX];
    size_t len = 0;
    if (range.at + TSR_RANGE_FINISH_LEN_MAX <= range.cap) {
        return true;
    }
    if (range.at > range.cap) {
        return false;
    }
    /* The tail alone, written elsewhere: a carry out of it changes bytes, not their number. */
    const size_t left = range.cap - range.at;
    range.out = spare;
    range.at = 0;
    range.cap = left;
    return tsr_range_encode_finish(&range, &len) == TSR_OK;
}

/* Back to an earlier state of the same stream. What was coded since may have carried into the bytes before, once: the
 * number is then one too large there. */
static void take_back(struct tsr_range_encoder *range, const struct tsr_range_encoder *before, uint8_t last_byte)
{
    *range = *before;
    if (before->at > 0 && before->out[before->at - 1u] != last_byte) {
        size_t i = before->at;
        while (i > 0 && before->out[i - 1u]-- == 0) {
            i--;
        }
    }
}

bool tsr_packet_fill(struct tsr_range_encoder *range, uint32_t limit, uint32_t group, tsr_packet_code_units *code,
                     void *codec, uint32_t *count)
{
    for (*count = 0; *count < limit;) {
        const uint32_t left = limit - *count, next = left < group ? left : group;
        const struct tsr_range_encoder before = *range;
        const uint8_t last_byte = before.at > 0 ? before.out[before.at - 1u] : 0;
        if (!code(codec, range, *count, next)) {
            return false;
        }
        if (!would_fit(*range)) {
            take_back(range, &before, last_byte);
            break;
        }
        *count += next;
    }
    return true;
}

uint32_t tsr_packet_literal_count(size_t payload_cap, unsigned unit_bits, uint32_t group)
{
    return (uint32_t)((payload_cap - TSR_RANGE_FINISH_LEN_MAX) * 8u / unit_bits) / group * group;
}

bool tsr_packets_have(const uint8_t *arrived, uint16_t width, uint16_t height, uint16_t x, uint16_t y)
{
    const uint32_t strip_x = x / TSR_PACKET_STRIP_PX * TSR_PACKET_STRIP_PX;
    const uint32_t left = width - strip_x, strip_width = left < TSR_PACKET_STRIP_PX ? left : TSR_PACKET_STRIP_PX;
    const uint32_t group = (strip_x * height + y * strip_width + (x - strip_x)) / TSR_PACKET_GROUP_PX;
    return (arrived[group / 8u] >> group % 8u & 1u) != 0;
}

size_t tsr_packets_missing(const uint8_t *arrived, uint16_t width, uint16_t height)
{
    const uint32_t pixels = (uint32_t)width * height;
    size_t missing = 0;
    for (uint32_t first = 0; arrived != NULL && first < pixels; first += TSR_PACKET_GROUP_PX) {
        const uint32_t group = first / TSR_PACKET_GROUP_PX, left = pixels - first;
        if ((arrived[group / 8u] >> group % 8u & 1u) == 0) {
            missing += left < TSR_PACKET_GROUP_PX ? left : TSR_PACKET_GROUP_PX;
        }
    }
    return missing;
}

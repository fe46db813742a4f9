/*
 * Sending an image in packets and receiving it, for tests of any of the codecs. A test includes this header after
 * the codec's and after it has defined
 *
 *   PACKETS(name)                      tsr_<codec>_<name>
 *   PACKETS_MARKS_LEN(width, height)   bytes that mark what has come
 *   PACKETS_MISSING(info, marks)       units that have not
 *   PACKETS_UNITS(info)                all of them
 *   PACKETS_HAVE(info, marks, x, y)    whether pixel (x, y) has come
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TESTS_CODEC_PACKETS_H
#define TSR_TESTS_CODEC_PACKETS_H

#include <string.h>

#include "codec_random.h"
#include "unity.h"

#define PACKETS_WIDTH_MAX 160u
#define PACKETS_HEIGHT_MAX 120u
#define PACKETS_STRIDE_MAX (PACKETS_WIDTH_MAX + 7u)
#define PACKETS_COUNT_MAX 2400u
#define PACKETS_CAP_MAX 200u
#define PACKETS_UNTOUCHED 0x5a

static struct PACKETS(packet_encoder) encoder;
static struct PACKETS(packet_state) state;
static uint8_t image[PACKETS_STRIDE_MAX * PACKETS_HEIGHT_MAX];
static uint8_t decoded[PACKETS_STRIDE_MAX * PACKETS_HEIGHT_MAX];
static uint8_t marks[PACKETS_MARKS_LEN(PACKETS_WIDTH_MAX, PACKETS_HEIGHT_MAX)];
static uint8_t packets[PACKETS_COUNT_MAX][PACKETS_CAP_MAX];
static size_t packet_lens[PACKETS_COUNT_MAX];

/* The whole image in packets of at most cap bytes; gives their number. */
static unsigned send_all(const struct PACKETS(info) * info, size_t stride, size_t cap, uint8_t id)
{
    unsigned count = 0;
    enum tsr_status status = TSR_AGAIN;
    TEST_ASSERT_EQUAL(TSR_OK, PACKETS(packets_start)(&encoder, info, image, stride, id));
    while (status == TSR_AGAIN) {
        TEST_ASSERT_LESS_THAN(PACKETS_COUNT_MAX, count);
        memset(packets[count], 0xa5, PACKETS_CAP_MAX);
        status = PACKETS(packets_next)(&encoder, packets[count], cap, &packet_lens[count]);
        TEST_ASSERT_GREATER_OR_EQUAL(TSR_OK, status);
        TEST_ASSERT_LESS_OR_EQUAL(cap, packet_lens[count]);
        for (size_t i = cap; i < PACKETS_CAP_MAX; i++) {
            TEST_ASSERT_EQUAL_HEX8(0xa5, packets[count][i]);
        }
        count++;
    }
    return count;
}

static enum tsr_status receive_bytes(const struct PACKETS(info) * info, size_t stride, uint8_t id, const uint8_t *bytes,
                                     size_t len, struct tsr_packet *packet)
{
    return PACKETS(packet_decode)(&state, info, id, bytes, len, packet, decoded, stride, marks,
                                  PACKETS_MARKS_LEN(info->width, info->height));
}

static struct tsr_packet receive(const struct PACKETS(info) * info, size_t stride, uint8_t id, unsigned i)
{
    struct tsr_packet packet = {.count = 0};
    TEST_ASSERT_EQUAL(TSR_OK, receive_bytes(info, stride, id, packets[i], packet_lens[i], &packet));
    TEST_ASSERT_EQUAL(id, packet.id);
    return packet;
}

static void receive_nothing(void)
{
    memset(decoded, PACKETS_UNTOUCHED, sizeof decoded);
    memset(marks, 0, sizeof marks);
}

#endif

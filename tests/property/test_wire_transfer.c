/*
 * Random messages over a bad way: fragment, shuffle, repeat, lose; reassemble,
 * answer, send again what is missing, until nothing is.
 *
 * SEED and RUNS choose the cases; a failure prints its seed.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdio.h>
#include <string.h>

#include "codec_random.h"
#include "mbedtls_aes.h"
#include "tsr/wire/body.h"
#include "unity.h"

#define BODY_MAX 65535u
#define ROUNDS_MAX 400u

static uint8_t message[BODY_MAX + TSR_MESSAGE_OVERHEAD_LEN];
static uint8_t room[BODY_MAX + TSR_MESSAGE_OVERHEAD_LEN];
static uint8_t body[BODY_MAX];
static uint16_t wanted[TSR_FRAGMENT_COUNT_MAX];
static uint64_t first_seed = 1;
static uint64_t run_count = 400;
static char failing[64];

void setUp(void) {}
void tearDown(void) {}

static size_t random_len(struct codec_random *random)
{
    const uint32_t limits[] = {1, 76, 77, 200, 3000, BODY_MAX};
    return codec_random_below(random, limits[codec_random_below(random, 6)] + 1u);
}

static void shuffle(struct codec_random *random, uint16_t *values, unsigned count)
{
    for (unsigned i = count; i > 1; i--) {
        const unsigned other = codec_random_below(random, i);
        const uint16_t swapped = values[i - 1];
        values[i - 1] = values[other];
        values[other] = swapped;
    }
}

/* One fragment through bytes into the reassembly. */
static void deliver(struct tsr_reassembly *reassembly, size_t message_len, uint16_t index)
{
    struct tsr_fragment fragment = tsr_fragment_of(message, message_len, index);
    struct tsr_fragment read;
    uint8_t bytes[TSR_FRAME_PAYLOAD_MAX];
    size_t len = 0;
    fragment.origin = 3;
    fragment.message_id = 42;
    TEST_ASSERT_EQUAL_MESSAGE(TSR_OK, tsr_fragment_write(&fragment, bytes, sizeof bytes, &len), failing);
    TEST_ASSERT_EQUAL_MESSAGE(TSR_OK, tsr_fragment_read(bytes, len, &read), failing);
    if (!tsr_reassembly_matches(reassembly, &read)) {
        TEST_ASSERT_EQUAL_MESSAGE(TSR_OK, tsr_reassembly_begin(reassembly, &read), failing);
    }
    TEST_ASSERT_TRUE_MESSAGE(tsr_reassembly_add(reassembly, &read) >= TSR_OK, failing);
}

/* The answer, through bytes; its indices into wanted. */
static unsigned ask(const struct tsr_reassembly *reassembly)
{
    const struct tsr_body_status status = tsr_body_status_of(reassembly, TSR_DELIVERY_COMMITTED);
    struct tsr_body_status read;
    uint8_t bytes[TSR_BODY_STATUS_MAX];
    size_t len = 0;
    unsigned count = 0;
    TEST_ASSERT_EQUAL_MESSAGE(TSR_OK, tsr_body_write_status(&status, bytes, sizeof bytes, &len), failing);
    TEST_ASSERT_EQUAL_MESSAGE(TSR_OK, tsr_body_read_status(bytes, len, &read), failing);
    for (unsigned i = 0; i < 8u * read.bitmap_len; i++) {
        if ((read.bitmap[i / 8] >> i % 8 & 1) != 0) {
            TEST_ASSERT_LESS_THAN_MESSAGE(reassembly->count, read.first + i, failing);
            wanted[count++] = (uint16_t)(read.first + i);
        }
    }
    TEST_ASSERT_EQUAL_MESSAGE(read.state == TSR_DELIVERY_COMMITTED, count == 0, failing);
    return count;
}

static void transfer(uint64_t seed)
{
    struct codec_random random = codec_random_of_seed(seed);
    const struct tsr_cipher cipher = test_cipher((uint8_t)seed);
    const struct tsr_message_header header = {TSR_MESSAGE_MAP, TSR_KEY_NODE, 3, 0, (uint32_t)seed};
    const size_t body_len = random_len(&random);
    const uint32_t loss_percent = codec_random_below(&random, 90);
    size_t message_len = 0;
    (void)snprintf(failing, sizeof failing, "replay: SEED=%llu RUNS=1", (unsigned long long)seed);
    for (size_t i = 0; i < body_len; i++) {
        body[i] = (uint8_t)codec_random_next(&random);
    }
    memcpy(message + TSR_MESSAGE_HEADER_LEN, body, body_len);
    TEST_ASSERT_EQUAL_MESSAGE(
        TSR_OK, tsr_message_seal(&header, &cipher, message, sizeof message, body_len, &message_len), failing);

    struct tsr_reassembly reassembly;
    unsigned count = tsr_fragment_count(message_len);
    for (unsigned i = 0; i < count; i++) {
        wanted[i] = (uint16_t)i;
    }
    tsr_reassembly_init(&reassembly, room, message_len);
    for (unsigned round = 0; count > 0; round++) {
        TEST_ASSERT_LESS_THAN_MESSAGE(ROUNDS_MAX, round, failing);
        shuffle(&random, wanted, count);
        for (unsigned i = 0; i < count; i++) {
            for (unsigned copies = 1 + (codec_random_below(&random, 8) == 0 ? 1 : 0); copies > 0; copies--) {
                if (codec_random_below(&random, 100) >= loss_percent || (i == 0 && reassembly.count == 0)) {
                    deliver(&reassembly, message_len, wanted[i]);
                }
            }
        }
        count = ask(&reassembly);
    }
    struct tsr_message_header read;
    size_t opened_len = 0;
    TEST_ASSERT_EQUAL_MESSAGE(message_len, reassembly.message_len, failing);
    TEST_ASSERT_EQUAL_MESSAGE(TSR_OK, tsr_message_parse(room, reassembly.message_len, 3, 0, &read), failing);
    TEST_ASSERT_EQUAL_MESSAGE(TSR_OK, tsr_message_open(&read, &cipher, room, reassembly.message_len, &opened_len),
                              failing);
    TEST_ASSERT_EQUAL_MESSAGE(body_len, opened_len, failing);
    TEST_ASSERT_EQUAL_MESSAGE(0, memcmp(body, room + TSR_MESSAGE_HEADER_LEN, body_len), failing);
}

static void test_random_messages_arrive(void)
{
    for (uint64_t seed = first_seed; seed < first_seed + run_count; seed++) {
        transfer(seed);
    }
}

int main(void)
{
    first_seed = codec_setting("SEED", first_seed);
    run_count = codec_setting("RUNS", run_count);
    UNITY_BEGIN();
    RUN_TEST(test_random_messages_arrive);
    return UNITY_END();
}

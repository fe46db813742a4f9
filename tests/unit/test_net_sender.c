/*
 * Sender: selective repeat over a real MAC with a fake radio; routes.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "fake_radio.h"
#include "mbedtls_aes.h"
#include "tsr/net/sender.h"
#include "unity.h"

#define SELF 0x0003u
#define PARENT 0x0002u
#define TOKEN 77u
#define COUNTER 0x00051234u
#define MESSAGE_ID 0x1234u
#define PIECE TSR_FRAGMENT_PIECE_MAX

static struct tsr_cipher cipher;
static struct tsr_mac mac;
static struct fake_radio radio;
static struct fake_entropy entropy;
static struct tsr_sender sender;
static struct tsr_routes routes;
static uint8_t message[700 * PIECE];
static uint64_t now_us;

void setUp(void)
{
    const struct tsr_mac_config config = {0xbeef, SELF, 15, 1};
    memset(&radio, 0, sizeof radio);
    memset(&entropy, 0, sizeof entropy);
    memset(&routes, 0, sizeof routes);
    routes.parent = PARENT;
    cipher = test_cipher(1);
    now_us = 1000;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_mac_init(&mac, &config, &cipher, fake_radio_of(&radio), fake_entropy_of(&entropy)));
    tsr_sender_init(&sender, SELF, TOKEN);
    for (size_t i = 0; i < sizeof message; i++) {
        message[i] = (uint8_t)(i / PIECE);
    }
}
void tearDown(void) {}

static void start(size_t count)
{
    TEST_ASSERT_EQUAL(TSR_OK, tsr_sender_start(&sender, message, count * PIECE, 0, COUNTER, now_us));
}

static void take_confirms(void)
{
    struct tsr_mac_confirm confirm;
    while (tsr_mac_confirmed(&mac, &confirm)) {
        TEST_ASSERT_EQUAL(TOKEN, confirm.token);
        tsr_sender_on_confirm(&sender, &confirm, now_us);
    }
}

static void step(void)
{
    tsr_sender_step(&sender, &mac, &routes, now_us);
    tsr_mac_on_timer(&mac, now_us);
}

/* The fragment on air, or NULL if there is none. */
static const struct tsr_fragment *on_air(void)
{
    static struct tsr_fragment fragment;
    static uint8_t payload[TSR_FRAME_PAYLOAD_MAX];
    struct tsr_frame_header header;
    size_t len = 0;
    step();
    if (!radio.busy) {
        return NULL;
    }
    TEST_ASSERT_EQUAL(TSR_OK, tsr_frame_parse(radio.sent, radio.sent_len, &header));
    TEST_ASSERT_EQUAL(PARENT, header.destination);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_frame_open(radio.sent, radio.sent_len, &cipher, payload, sizeof payload, &len));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_fragment_read(payload, len, &fragment));
    TEST_ASSERT_EQUAL(SELF, fragment.origin);
    TEST_ASSERT_EQUAL(0, fragment.destination);
    TEST_ASSERT_EQUAL_HEX16(MESSAGE_ID, fragment.message_id);
    TEST_ASSERT_EQUAL_HEX8((uint8_t)fragment.index, fragment.piece[0]);
    return &fragment;
}

static void finish(enum tsr_radio_outcome outcome)
{
    const struct tsr_radio_event event = fake_radio_done(&radio, outcome, now_us += 4000);
    tsr_mac_on_radio(&mac, &event, now_us);
    tsr_mac_on_timer(&mac, now_us);
}

static void pass(void)
{
    finish(TSR_RADIO_ACKED);
    take_confirms();
}

/* The next hop answers none of the four attempts. */
static void fail_hop(void)
{
    for (unsigned i = 0; i <= TSR_MAC_MAX_FRAME_RETRIES; i++) {
        finish(TSR_RADIO_NO_ACK);
    }
    take_confirms();
}

static void expect_fragment(uint16_t index, bool poll)
{
    const struct tsr_fragment *fragment = on_air();
    TEST_ASSERT_NOT_NULL(fragment);
    TEST_ASSERT_EQUAL(index, fragment->index);
    TEST_ASSERT_EQUAL(poll, fragment->poll);
    pass();
}

static void answer(enum tsr_delivery state, uint16_t first, unsigned bitmap_len, uint8_t bits)
{
    struct tsr_body_status status;
    memset(&status, 0, sizeof status);
    status.message_id = MESSAGE_ID;
    status.state = (uint8_t)state;
    status.first = first;
    status.bitmap_len = (uint8_t)bitmap_len;
    memset(status.bitmap, bits, bitmap_len);
    tsr_sender_on_status(&sender, &status, now_us);
}

static void wait_for_timer(void)
{
    TEST_ASSERT_TRUE(tsr_sender_timer_us(&sender) != TSR_TIME_NEVER);
    now_us = tsr_sender_timer_us(&sender);
}

static void test_calm_run(void)
{
    start(5);
    for (uint16_t i = 0; i < 5; i++) {
        expect_fragment(i, i == 4);
    }
    TEST_ASSERT_NULL(on_air());
    TEST_ASSERT_FALSE(tsr_sender_is_idle(&sender));
    answer(TSR_DELIVERY_COMMITTED, 0, 0, 0);
    TEST_ASSERT_TRUE(tsr_sender_is_idle(&sender));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_sender_result(&sender));
    TEST_ASSERT_EQUAL_UINT64(TSR_TIME_NEVER, tsr_sender_timer_us(&sender));
    TEST_ASSERT_EQUAL(5, sender.counters.fragments);
    TEST_ASSERT_EQUAL(0, sender.counters.fragments_again);
}

static void test_one_fragment_polls(void)
{
    start(1);
    expect_fragment(0, true);
}

static void test_missing_ones_are_sent_again_and_only_they(void)
{
    start(20);
    for (uint16_t i = 0; i < 20; i++) {
        expect_fragment(i, i == 19);
    }
    answer(TSR_DELIVERY_MISSING, 8, 1, 0x12); /* 9 and 12 */
    expect_fragment(9, false);
    expect_fragment(12, true);
    answer(TSR_DELIVERY_MISSING, 16, 1, 0xf8); /* 19; the rest is beyond the message */
    expect_fragment(19, true);
    TEST_ASSERT_EQUAL(3, sender.counters.fragments_again);
    answer(TSR_DELIVERY_COMMITTED, 0, 0, 0);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_sender_result(&sender));
}

static void test_longer_than_a_bitmap(void)
{
    start(700);
    for (uint16_t i = 0; i < 700; i++) {
        expect_fragment(i, i == 699);
    }
    answer(TSR_DELIVERY_MISSING, 0, TSR_BODY_STATUS_BITMAP_MAX, 0xff); /* 568 of them */
    for (uint16_t i = 0; i < 568; i++) {
        TEST_ASSERT_NOT_NULL(on_air());
        pass();
    }
    answer(TSR_DELIVERY_MISSING, 568, 17, 0xff); /* 132 */
    for (uint16_t i = 0; i < 132; i++) {
        const struct tsr_fragment *fragment = on_air();
        TEST_ASSERT_NOT_NULL(fragment);
        TEST_ASSERT_GREATER_OR_EQUAL(568, fragment->index);
        TEST_ASSERT_EQUAL(i == 131, fragment->poll);
        pass();
    }
    answer(TSR_DELIVERY_COMMITTED, 0, 0, 0);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_sender_result(&sender));
}

static void test_lost_status_is_polled_for(void)
{
    start(3);
    for (uint16_t i = 0; i < 3; i++) {
        expect_fragment(i, i == 2);
    }
    uint64_t wait_us = TSR_SENDER_WAIT_MIN_US;
    for (unsigned polls = 1; polls < TSR_SENDER_TRIES_MAX; polls++) {
        TEST_ASSERT_EQUAL_UINT64(now_us + wait_us, tsr_sender_timer_us(&sender));
        now_us = tsr_sender_timer_us(&sender) - 1;
        TEST_ASSERT_NULL(on_air());
        now_us++;
        expect_fragment(2, true);
        TEST_ASSERT_EQUAL(polls, sender.counters.polls);
        wait_us = 2 * wait_us < TSR_SENDER_WAIT_MAX_US ? 2 * wait_us : TSR_SENDER_WAIT_MAX_US;
    }
    TEST_ASSERT_FALSE(tsr_sender_is_idle(&sender)); /* the last poll may be answered, too */
    wait_for_timer();
    TEST_ASSERT_NULL(on_air());
    TEST_ASSERT_TRUE(tsr_sender_is_idle(&sender));
    TEST_ASSERT_EQUAL(TSR_ERR_TIMEOUT, tsr_sender_result(&sender));
}

static void test_failed_hop_repeats_the_fragment(void)
{
    start(3);
    TEST_ASSERT_NOT_NULL(on_air());
    fail_hop();
    TEST_ASSERT_NULL(on_air());
    TEST_ASSERT_EQUAL_UINT64(now_us + TSR_SENDER_HOP_WAIT_US, tsr_sender_timer_us(&sender));
    wait_for_timer();
    for (uint16_t i = 0; i < 3; i++) {
        expect_fragment(i, i == 2);
    }
    TEST_ASSERT_EQUAL(1, sender.counters.fragments_again);
}

static void test_dead_hop_is_given_up(void)
{
    start(3);
    unsigned attempts = 0;
    while (!tsr_sender_is_idle(&sender)) {
        if (on_air() != NULL) {
            attempts++;
            fail_hop();
            wait_for_timer();
        }
    }
    TEST_ASSERT_EQUAL(TSR_SENDER_TRIES_MAX, attempts);
    TEST_ASSERT_EQUAL(TSR_ERR_TIMEOUT, tsr_sender_result(&sender));
}

static void test_refused(void)
{
    start(2);
    expect_fragment(0, false);
    expect_fragment(1, true);
    answer(TSR_DELIVERY_REFUSED, 0, 0, 0);
    TEST_ASSERT_TRUE(tsr_sender_is_idle(&sender));
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, tsr_sender_result(&sender));
}

/* A destination that asks for the same again and again makes no progress. */
static void test_endless_missing_is_given_up(void)
{
    start(3);
    unsigned sent = 0;
    while (!tsr_sender_is_idle(&sender)) {
        TEST_ASSERT_LESS_THAN(200, sent);
        const struct tsr_fragment *fragment = on_air();
        TEST_ASSERT_NOT_NULL(fragment);
        const bool poll = fragment->poll;
        pass();
        sent++;
        if (poll) {
            answer(TSR_DELIVERY_MISSING, 0, 1, 0x07);
        }
    }
    TEST_ASSERT_EQUAL(TSR_ERR_TIMEOUT, tsr_sender_result(&sender));
}

/* Any number of answers that show progress is well. */
static void test_slow_progress_is_not_given_up(void)
{
    start(160);
    for (uint16_t i = 0; i < 160; i++) {
        expect_fragment(i, i == 159);
    }
    for (uint16_t left = 160; left > 0; left--) { /* one fragment comes through in each round */
        struct tsr_body_status status;
        memset(&status, 0, sizeof status);
        status.message_id = MESSAGE_ID;
        status.state = TSR_DELIVERY_MISSING;
        status.bitmap_len = 20;
        for (unsigned i = 0; i < left; i++) {
            status.bitmap[i / 8] |= (uint8_t)(1u << i % 8);
        }
        tsr_sender_on_status(&sender, &status, now_us);
        TEST_ASSERT_FALSE(tsr_sender_is_idle(&sender));
        for (uint16_t i = 0; i < left; i++) {
            TEST_ASSERT_NOT_NULL(on_air());
            pass();
        }
    }
    answer(TSR_DELIVERY_COMMITTED, 0, 0, 0);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_sender_result(&sender));
}

static void test_status_overtakes_the_confirm(void)
{
    start(1);
    TEST_ASSERT_NOT_NULL(on_air());
    finish(TSR_RADIO_ACKED);
    answer(TSR_DELIVERY_COMMITTED, 0, 0, 0);
    TEST_ASSERT_FALSE(tsr_sender_is_idle(&sender)); /* its frame still holds the token */
    TEST_ASSERT_EQUAL(TSR_ERR_BUSY, tsr_sender_start(&sender, message, 1, 0, 2, now_us));
    take_confirms();
    TEST_ASSERT_TRUE(tsr_sender_is_idle(&sender));
}

static void test_foreign_and_late_answers(void)
{
    struct tsr_body_status status;
    memset(&status, 0, sizeof status);
    status.state = TSR_DELIVERY_COMMITTED;
    status.message_id = MESSAGE_ID + 1;
    start(2);
    tsr_sender_on_status(&sender, &status, now_us);
    TEST_ASSERT_FALSE(tsr_sender_is_idle(&sender));
    expect_fragment(0, false);
    answer(TSR_DELIVERY_MISSING, 0, 1, 0x01); /* an old one: the rest is not sent yet */
    expect_fragment(1, true);
    answer(TSR_DELIVERY_MISSING, 0, 0, 0); /* names nothing: nothing to send */
    TEST_ASSERT_NULL(on_air());
    answer(TSR_DELIVERY_COMMITTED, 0, 0, 0);
    answer(TSR_DELIVERY_REFUSED, 0, 0, 0); /* too late */
    TEST_ASSERT_EQUAL(TSR_OK, tsr_sender_result(&sender));
}

static void test_abort(void)
{
    start(3);
    TEST_ASSERT_NOT_NULL(on_air());
    tsr_sender_abort(&sender);
    memset(message, 0x99, 3 * PIECE); /* the caller's again at once */
    TEST_ASSERT_FALSE(tsr_sender_is_idle(&sender));
    /* The old frame's confirm must not be taken for one of a new message. */
    TEST_ASSERT_EQUAL(TSR_ERR_BUSY, tsr_sender_start(&sender, message, 2, 0, 9, now_us));
    pass();
    TEST_ASSERT_TRUE(tsr_sender_is_idle(&sender));
    TEST_ASSERT_NULL(on_air());
    TEST_ASSERT_EQUAL(TSR_OK, tsr_sender_start(&sender, message, 2, 0, 9, now_us));
}

static void test_start_refuses(void)
{
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_sender_start(&sender, message, 0, 0, 1, now_us));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE,
                      tsr_sender_start(&sender, message, TSR_FRAGMENT_COUNT_MAX * PIECE + 1, 0, 1, now_us));
    TEST_ASSERT_TRUE(tsr_sender_is_idle(&sender));
    start(1);
    TEST_ASSERT_EQUAL(TSR_ERR_BUSY, tsr_sender_start(&sender, message, 1, 0, 1, now_us));
}

static void test_no_route(void)
{
    routes.parent = TSR_ADDRESS_NONE;
    start(1);
    step();
    TEST_ASSERT_TRUE(tsr_sender_is_idle(&sender));
    TEST_ASSERT_EQUAL(TSR_ERR_NOROUTE, tsr_sender_result(&sender));
}

static void test_full_mac_waits(void)
{
    const uint8_t payload = 1;
    start(1);
    while (tsr_mac_room(&mac) > 0) {
        TEST_ASSERT_EQUAL(TSR_OK, tsr_mac_send(&mac, PARENT, &payload, 1, TOKEN, false));
    }
    tsr_sender_step(&sender, &mac, &routes, now_us);
    TEST_ASSERT_FALSE(tsr_sender_is_idle(&sender));
    TEST_ASSERT_EQUAL(0, sender.counters.fragments);
}

static void test_routes(void)
{
    const struct tsr_route table[] = {{5, 5}, {6, 5}, {0xfffd, 7}};
    routes.descendants = table;
    routes.descendant_count = 3;
    TEST_ASSERT_EQUAL(5, tsr_route_next(&routes, 5));
    TEST_ASSERT_EQUAL(5, tsr_route_next(&routes, 6));
    TEST_ASSERT_EQUAL(7, tsr_route_next(&routes, 0xfffd));
    TEST_ASSERT_EQUAL(PARENT, tsr_route_next(&routes, 0));
    TEST_ASSERT_EQUAL(PARENT, tsr_route_next(&routes, 8));
    routes.descendant_count = 2;
    TEST_ASSERT_EQUAL(PARENT, tsr_route_next(&routes, 0xfffd));
    routes.parent = TSR_ADDRESS_NONE;
    TEST_ASSERT_EQUAL(TSR_ADDRESS_NONE, tsr_route_next(&routes, 8));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_calm_run);
    RUN_TEST(test_one_fragment_polls);
    RUN_TEST(test_missing_ones_are_sent_again_and_only_they);
    RUN_TEST(test_longer_than_a_bitmap);
    RUN_TEST(test_lost_status_is_polled_for);
    RUN_TEST(test_failed_hop_repeats_the_fragment);
    RUN_TEST(test_dead_hop_is_given_up);
    RUN_TEST(test_refused);
    RUN_TEST(test_endless_missing_is_given_up);
    RUN_TEST(test_slow_progress_is_not_given_up);
    RUN_TEST(test_status_overtakes_the_confirm);
    RUN_TEST(test_foreign_and_late_answers);
    RUN_TEST(test_abort);
    RUN_TEST(test_start_refuses);
    RUN_TEST(test_no_route);
    RUN_TEST(test_full_mac_waits);
    RUN_TEST(test_routes);
    return UNITY_END();
}

/*
 * MAC: back-off, retries, confirms, the receive ring, replay, worn-out keys.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "fake_radio.h"
#include "mbedtls_aes.h"
#include "tsr/net/mac.h"
#include "tsr/wire/address.h"
#include "unity.h"

#define PAN 0xbeefu
#define SELF 0x0003u
#define PEER 0x0002u
#define UNIT_US TSR_MAC_UNIT_BACKOFF_US

static struct tsr_cipher cipher;
static struct tsr_mac mac;
static struct fake_radio radio;
static struct fake_entropy entropy;
static uint64_t now_us;

static void init(uint32_t counter_start)
{
    const struct tsr_mac_config config = {PAN, SELF, 15, counter_start};
    TEST_ASSERT_EQUAL(TSR_OK, tsr_mac_init(&mac, &config, &cipher, fake_radio_of(&radio), fake_entropy_of(&entropy)));
}

void setUp(void)
{
    memset(&radio, 0, sizeof radio);
    memset(&entropy, 0, sizeof entropy);
    cipher = test_cipher(1);
    now_us = 1000;
    init(100);
}
void tearDown(void) {}

static void send(uint16_t peer, uint16_t token, bool once)
{
    const uint8_t payload[3] = {1, 2, (uint8_t)token};
    TEST_ASSERT_EQUAL(TSR_OK, tsr_mac_send(&mac, peer, payload, sizeof payload, token, once));
    tsr_mac_on_timer(&mac, now_us);
}

/* Let the back-off pass, if one is left: the radio then has the frame. */
static void pass_backoff(void)
{
    if (radio.busy) {
        return;
    }
    TEST_ASSERT_TRUE(tsr_mac_timer_us(&mac) != TSR_TIME_NEVER);
    now_us = tsr_mac_timer_us(&mac) > now_us ? tsr_mac_timer_us(&mac) : now_us;
    tsr_mac_on_timer(&mac, now_us);
}

static void finish(enum tsr_radio_outcome outcome)
{
    TEST_ASSERT_TRUE(radio.busy);
    TEST_ASSERT_TRUE(fake_radio_psdu_kept(&radio));
    const struct tsr_radio_event event = fake_radio_done(&radio, outcome, now_us += 2000);
    tsr_mac_on_radio(&mac, &event, now_us + 10);
    tsr_mac_on_timer(&mac, now_us + 10);
}

static void expect_confirm(uint16_t token, enum tsr_status status)
{
    struct tsr_mac_confirm confirm;
    TEST_ASSERT_TRUE(tsr_mac_confirmed(&mac, &confirm));
    TEST_ASSERT_EQUAL(token, confirm.token);
    TEST_ASSERT_EQUAL(status, confirm.status);
}

static void expect_no_confirm(void)
{
    struct tsr_mac_confirm confirm;
    TEST_ASSERT_FALSE(tsr_mac_confirmed(&mac, &confirm));
}

static void test_config(void)
{
    struct tsr_mac_config config = {PAN, SELF, 15, 0};
    const struct {
        uint16_t address;
        uint8_t channel;
        enum tsr_status status;
    } cases[] = {{0, 15, TSR_ERR_ARG}, {0xfffe, 15, TSR_ERR_ARG}, {0xffff, 15, TSR_ERR_ARG}, {1, 10, TSR_ERR_ARG},
                 {1, 27, TSR_ERR_ARG}, {1, 11, TSR_OK},           {0xfffd, 26, TSR_OK}};
    for (unsigned i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        config.address = cases[i].address;
        config.channel = cases[i].channel;
        TEST_ASSERT_EQUAL(cases[i].status,
                          tsr_mac_init(&mac, &config, &cipher, fake_radio_of(&radio), fake_entropy_of(&entropy)));
    }
    radio.on_configure = TSR_ERR_IO;
    TEST_ASSERT_EQUAL(TSR_ERR_IO,
                      tsr_mac_init(&mac, &config, &cipher, fake_radio_of(&radio), fake_entropy_of(&entropy)));
    radio.on_configure = TSR_OK;
    radio.on_receiving = TSR_ERR_IO;
    TEST_ASSERT_EQUAL(TSR_ERR_IO,
                      tsr_mac_init(&mac, &config, &cipher, fake_radio_of(&radio), fake_entropy_of(&entropy)));
}

static void test_payload_limits(void)
{
    const uint8_t payload[TSR_FRAME_PAYLOAD_MAX + 1] = {0};
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_mac_send(&mac, PEER, payload, 0, 1, false));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_mac_send(&mac, PEER, payload, TSR_FRAME_PAYLOAD_MAX + 1, 1, false));
    TEST_ASSERT_EQUAL(TSR_MAC_QUEUE_LEN, tsr_mac_room(&mac));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_mac_send(&mac, PEER, payload, TSR_FRAME_PAYLOAD_MAX, 1, false));
    TEST_ASSERT_EQUAL(TSR_MAC_QUEUE_LEN - 1, tsr_mac_room(&mac));
}

/* The first back-off is 0 .. 2^3 - 1 periods, whatever the random byte. */
static void test_first_backoff_in_bounds(void)
{
    for (unsigned random = 0; random < 256; random++) {
        setUp();
        entropy.value = (uint8_t)random;
        send(PEER, 1, false);
        if (random % 8 == 0) {
            TEST_ASSERT_EQUAL(1, radio.transmits);
        } else {
            TEST_ASSERT_EQUAL_UINT64(1000 + random % 8 * UNIT_US, tsr_mac_timer_us(&mac));
            tsr_mac_on_timer(&mac, tsr_mac_timer_us(&mac) - 1);
            TEST_ASSERT_EQUAL(0, radio.transmits);
            pass_backoff();
            TEST_ASSERT_EQUAL(1, radio.transmits);
        }
    }
}

/* IEEE 802.15.4-2015, 6.2.5.1: BE 3, 4, 5, 5, 5; after macMaxCsmaBackoffs + 1 assessments it gives up. */
static void test_busy_channel(void)
{
    const unsigned masks[] = {7, 15, 31, 31, 31};
    entropy.value = 0xff;
    send(PEER, 7, false);
    for (unsigned assessment = 0; assessment < 5; assessment++) {
        TEST_ASSERT_EQUAL(assessment, radio.transmits);
        const uint64_t from_us = assessment == 0 ? 1000 : now_us + 10;
        TEST_ASSERT_EQUAL_UINT64(from_us + masks[assessment] * UNIT_US, tsr_mac_timer_us(&mac));
        pass_backoff();
        finish(TSR_RADIO_CHANNEL_BUSY);
    }
    TEST_ASSERT_EQUAL(5, radio.transmits);
    expect_confirm(7, TSR_ERR_BUSY);
    TEST_ASSERT_EQUAL(1, mac.counters.channel_busy);
    TEST_ASSERT_EQUAL_UINT64(TSR_TIME_NEVER, tsr_mac_timer_us(&mac));
}

/* The same bytes each time: a retry is no new use of the key. */
static void test_retries(void)
{
    uint8_t first[TSR_FRAME_PSDU_MAX];
    send(PEER, 3, false);
    for (unsigned attempt = 0; attempt <= TSR_MAC_MAX_FRAME_RETRIES; attempt++) {
        pass_backoff();
        TEST_ASSERT_EQUAL(attempt + 1, radio.transmits);
        if (attempt == 0) {
            memcpy(first, radio.sent, radio.sent_len);
        }
        TEST_ASSERT_EQUAL_HEX8_ARRAY(first, radio.sent, radio.sent_len);
        expect_no_confirm();
        finish(attempt == 1 ? TSR_RADIO_FAULT : TSR_RADIO_NO_ACK);
    }
    expect_confirm(3, TSR_ERR_TIMEOUT);
    TEST_ASSERT_EQUAL(3, mac.counters.retries);
    TEST_ASSERT_EQUAL(1, mac.counters.unacknowledged);
    TEST_ASSERT_EQUAL(4, radio.transmits);
}

static void test_once_is_not_repeated(void)
{
    send(PEER, 3, true);
    pass_backoff();
    finish(TSR_RADIO_CHANNEL_BUSY); /* nothing was on air: the channel may be tried again */
    pass_backoff();
    finish(TSR_RADIO_NO_ACK);
    expect_confirm(3, TSR_ERR_TIMEOUT);
    TEST_ASSERT_EQUAL(2, radio.transmits);
}

static void test_confirm_time_is_the_end_of_the_frame(void)
{
    struct tsr_mac_confirm confirm;
    send(PEER, 3, true);
    pass_backoff();
    finish(TSR_RADIO_ACKED);
    TEST_ASSERT_TRUE(tsr_mac_confirmed(&mac, &confirm));
    TEST_ASSERT_EQUAL_UINT64(now_us, confirm.time_us);
}

static void test_broadcast_asks_for_no_ack(void)
{
    struct tsr_frame_header header;
    send(TSR_ADDRESS_BROADCAST, 3, false);
    pass_backoff();
    TEST_ASSERT_EQUAL(TSR_OK, tsr_frame_parse(radio.sent, radio.sent_len, &header));
    TEST_ASSERT_FALSE(header.ack_request);
    finish(TSR_RADIO_SENT);
    expect_confirm(3, TSR_OK);
}

static void test_confirms_keep_the_order(void)
{
    for (uint16_t token = 1; token <= TSR_MAC_QUEUE_LEN; token++) {
        send(PEER, token, false);
    }
    const uint8_t more = 1;
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_mac_send(&mac, PEER, &more, 1, 99, false));
    for (unsigned i = 0; i < TSR_MAC_QUEUE_LEN; i++) {
        if (!radio.busy) {
            pass_backoff();
        }
        finish(TSR_RADIO_ACKED);
    }
    for (uint16_t token = 1; token <= TSR_MAC_QUEUE_LEN; token++) {
        expect_confirm(token, TSR_OK);
    }
    expect_no_confirm();
}

/* A task that sends without taking confirms is stopped in time: each accepted
 * frame gets its confirm. */
static void test_no_confirm_is_lost(void)
{
    unsigned accepted = 0;
    const uint8_t payload = 1;
    for (unsigned i = 0; i < 5 * TSR_MAC_QUEUE_LEN; i++) {
        if (tsr_mac_room(&mac) > 0) {
            TEST_ASSERT_EQUAL(TSR_OK, tsr_mac_send(&mac, PEER, &payload, 1, (uint16_t)accepted++, false));
        } else {
            TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_mac_send(&mac, PEER, &payload, 1, 0, false));
        }
        tsr_mac_on_timer(&mac, now_us);
        if (radio.busy) {
            finish(TSR_RADIO_ACKED);
        }
    }
    TEST_ASSERT_GREATER_OR_EQUAL(TSR_MAC_QUEUE_LEN, accepted);
    for (unsigned i = 0; i < accepted; i++) {
        expect_confirm((uint16_t)i, TSR_OK);
    }
    expect_no_confirm();
    TEST_ASSERT_EQUAL(TSR_MAC_QUEUE_LEN, tsr_mac_room(&mac));
}

/* A radio that refuses once costs a back-off; one that refuses always ends the frame. */
static void test_refused_transmit(void)
{
    radio.on_transmit = TSR_ERR_IO;
    send(PEER, 4, false); /* no back-off: refused at once */
    TEST_ASSERT_EQUAL(1, radio.transmits);
    radio.on_transmit = TSR_OK;
    pass_backoff();
    finish(TSR_RADIO_ACKED);
    expect_confirm(4, TSR_OK);
    radio.on_transmit = TSR_ERR_IO;
    send(PEER, 5, false);
    for (unsigned i = 0; i < 100 && tsr_mac_timer_us(&mac) != TSR_TIME_NEVER; i++) {
        pass_backoff();
    }
    expect_confirm(5, TSR_ERR_BUSY);
    TEST_ASSERT_EQUAL(1, mac.counters.channel_busy);
}

/* A frame of peer with a counter, as the air brings it. */
static void hear(uint16_t source, uint16_t destination, uint16_t pan, uint32_t counter)
{
    const struct tsr_frame_header header = {9, true, pan, destination, source, counter};
    const uint8_t payload[2] = {7, (uint8_t)counter};
    uint8_t psdu[TSR_FRAME_PSDU_MAX];
    size_t len = 0;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_frame_seal(&header, &cipher, payload, sizeof payload, psdu, sizeof psdu, &len));
    const struct tsr_radio_event event = fake_radio_heard(psdu, len, now_us++);
    tsr_mac_on_radio(&mac, &event, now_us);
}

static void test_received_frames_in_order(void)
{
    for (uint32_t i = 0; i < 3; i++) {
        hear(PEER, SELF, PAN, 50 + i);
    }
    for (uint32_t i = 0; i < 3; i++) {
        const struct tsr_mac_frame *frame = tsr_mac_received(&mac);
        TEST_ASSERT_NOT_NULL(frame);
        TEST_ASSERT_EQUAL(PEER, frame->peer);
        TEST_ASSERT_EQUAL(2, frame->len);
        TEST_ASSERT_EQUAL(50 + i, frame->payload[1]);
        TEST_ASSERT_EQUAL(-60, frame->rssi_dbm);
        TEST_ASSERT_EQUAL_UINT64(1000 + i, frame->time_us);
        tsr_mac_release(&mac);
    }
    TEST_ASSERT_NULL(tsr_mac_received(&mac));
    tsr_mac_release(&mac); /* nothing to release is no harm */
    hear(PEER, SELF, PAN, 60);
    TEST_ASSERT_NOT_NULL(tsr_mac_received(&mac));
}

static void test_drops_have_their_counters(void)
{
    hear(PEER, SELF, 0x1234, 1); /* another PAN */
    hear(PEER, 0x0009, PAN, 2);  /* another node */
    TEST_ASSERT_EQUAL(2, mac.counters.dropped_format);
    hear(PEER, TSR_ADDRESS_BROADCAST, PAN, 3);
    TEST_ASSERT_EQUAL(1, mac.counters.received);
    const struct tsr_cipher other = test_cipher(2);
    mac.link_cipher = &other;
    hear(PEER, SELF, PAN, 5);
    TEST_ASSERT_EQUAL(1, mac.counters.dropped_auth);
    mac.link_cipher = &cipher;
    hear(PEER, SELF, PAN, 3); /* replay */
    hear(PEER, SELF, PAN, 2);
    TEST_ASSERT_EQUAL(2, mac.counters.dropped_replay);
    hear(PEER, SELF, PAN, 5);   /* not used up by the frame that did not authenticate */
    hear(0x0011, SELF, PAN, 1); /* counters are by source */
    TEST_ASSERT_EQUAL(3, mac.counters.received);
    const uint8_t noise[5] = {1, 2, 3, 4, 5};
    for (size_t len = 0; len <= sizeof noise; len++) {
        const struct tsr_radio_event event = fake_radio_heard(noise, len, now_us);
        tsr_mac_on_radio(&mac, &event, now_us);
    }
    TEST_ASSERT_EQUAL(8, mac.counters.dropped_format);
}

static void test_neighbour_table(void)
{
    for (uint16_t i = 0; i <= TSR_MAC_NEIGHBOURS_MAX; i++) {
        hear((uint16_t)(100 + i), SELF, PAN, 5);
        tsr_mac_release(&mac);
    }
    TEST_ASSERT_EQUAL(TSR_MAC_NEIGHBOURS_MAX, mac.counters.received);
    TEST_ASSERT_EQUAL(1, mac.counters.dropped_neighbour);
    hear(100, SELF, PAN, 6); /* known ones go on */
    TEST_ASSERT_EQUAL(TSR_MAC_NEIGHBOURS_MAX + 1, mac.counters.received);
}

/* What cannot be kept must not be acknowledged: a full ring stops the radio. */
static void test_full_ring_stops_listening(void)
{
    TEST_ASSERT_TRUE(radio.receiving);
    for (uint32_t i = 0; i < TSR_MAC_QUEUE_LEN; i++) {
        TEST_ASSERT_TRUE(radio.receiving);
        hear(PEER, SELF, PAN, i);
    }
    TEST_ASSERT_FALSE(radio.receiving);
    hear(PEER, SELF, PAN, 100); /* was already on its way */
    TEST_ASSERT_EQUAL(1, mac.counters.dropped_queue);
    tsr_mac_release(&mac);
    tsr_mac_on_timer(&mac, now_us);
    TEST_ASSERT_TRUE(radio.receiving);
    hear(PEER, SELF, PAN, 100); /* dropped, not seen: the repetition counts */
    TEST_ASSERT_EQUAL(TSR_MAC_QUEUE_LEN + 1, mac.counters.received);
}

/* IEEE 802.15.4-2015, 9.4.2.3: after the last counter the key is used up. Never
 * may a counter come again. */
static void test_worn_out_counter_never_wraps(void)
{
    init(0xfffffffeu);
    send(PEER, 1, false);
    pass_backoff();
    finish(TSR_RADIO_ACKED);
    expect_confirm(1, TSR_OK);
    const unsigned transmits = radio.transmits;
    for (uint16_t token = 2; token < 6; token++) {
        send(PEER, token, false);
        TEST_ASSERT_EQUAL(transmits, radio.transmits);
        expect_confirm(token, TSR_ERR_ARG);
    }
    TEST_ASSERT_EQUAL(4, mac.counters.unsealed);
    TEST_ASSERT_EQUAL_UINT64(TSR_TIME_NEVER, tsr_mac_timer_us(&mac));
}

static void test_counters_are_used_once(void)
{
    uint32_t last = 99;
    for (uint16_t token = 0; token < 20; token++) {
        struct tsr_frame_header header;
        send(PEER, token, false);
        pass_backoff();
        TEST_ASSERT_EQUAL(TSR_OK, tsr_frame_parse(radio.sent, radio.sent_len, &header));
        TEST_ASSERT_EQUAL(last + 1, header.counter);
        last = header.counter;
        finish(token % 2 == 0 ? TSR_RADIO_ACKED : TSR_RADIO_NO_ACK);
        while (tsr_mac_timer_us(&mac) != TSR_TIME_NEVER || radio.busy) {
            if (!radio.busy) {
                pass_backoff();
            }
            finish(TSR_RADIO_NO_ACK);
        }
        expect_confirm(token, token % 2 == 0 ? TSR_OK : TSR_ERR_TIMEOUT);
    }
}

static void test_stray_events_are_ignored(void)
{
    const struct tsr_radio_event event = fake_radio_done(&radio, TSR_RADIO_ACKED, now_us);
    tsr_mac_on_radio(&mac, &event, now_us);
    expect_no_confirm();
    entropy.value = 5;
    send(PEER, 1, false);
    tsr_mac_on_radio(&mac, &event, now_us); /* in BACKOFF */
    expect_no_confirm();
    pass_backoff();
    finish(TSR_RADIO_ACKED);
    expect_confirm(1, TSR_OK);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_config);
    RUN_TEST(test_payload_limits);
    RUN_TEST(test_first_backoff_in_bounds);
    RUN_TEST(test_busy_channel);
    RUN_TEST(test_retries);
    RUN_TEST(test_once_is_not_repeated);
    RUN_TEST(test_confirm_time_is_the_end_of_the_frame);
    RUN_TEST(test_broadcast_asks_for_no_ack);
    RUN_TEST(test_confirms_keep_the_order);
    RUN_TEST(test_no_confirm_is_lost);
    RUN_TEST(test_refused_transmit);
    RUN_TEST(test_received_frames_in_order);
    RUN_TEST(test_drops_have_their_counters);
    RUN_TEST(test_neighbour_table);
    RUN_TEST(test_full_ring_stops_listening);
    RUN_TEST(test_worn_out_counter_never_wraps);
    RUN_TEST(test_counters_are_used_once);
    RUN_TEST(test_stray_events_are_ignored);
    return UNITY_END();
}

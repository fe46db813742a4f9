/*
 * A node of each role under a storm: random bytes on air, rightly sealed frames
 * of random content, rightly sealed messages of random bodies, random bytes at
 * the gateway's port; between them all it waits for, and everything may fail.
 * It survives, its counters explain every frame, and it works afterwards.
 *
 * SEED and RUNS choose the storms; a failure prints its seed.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdio.h>

#include "codec_random.h"
#include "fake_node.h"
#include "unity.h"

#define EVENTS 1500u
#define STEPS_MAX 100000u
#define CALM_US 200000000u /* longer than any patience of a node */

static struct fake_node fake;
static struct codec_random dice;
static uint32_t heard;    /* frames the radio gave the MAC */
static uint32_t statuses; /* of these at most so many a node takes without a trace: a STATUS it no longer needs */
static uint64_t first_seed = 1;
static uint64_t run_count = 60;
static uint64_t maps;  /* made in all storms: how deep they went */
static uint64_t ended; /* maps and views that came to an end */
static char failing[64];

void setUp(void) {}
void tearDown(void) {}

static uint32_t roll(uint32_t count)
{
    return codec_random_below(&dice, count);
}

static void fill_random(uint8_t *bytes, size_t len)
{
    for (size_t i = 0; i < len; i++) {
        bytes[i] = (uint8_t)codec_random_next(&dice);
    }
}

static uint16_t some_address(void)
{
    const uint16_t addresses[] = {0, 1, 2, 3, 4, 5, 9, 0xfffe, 0xffff, fake.node.config.address};
    return addresses[roll(sizeof addresses / sizeof addresses[0])];
}

/* A full ring switches the radio off; then nothing is heard. */
static bool hears(void)
{
    heard += fake.radio.receiving ? 1 : 0;
    return fake.radio.receiving;
}

static void random_psdu(void)
{
    uint8_t psdu[TSR_FRAME_PSDU_MAX];
    const size_t len = roll(TSR_FRAME_PSDU_MAX + 1u);
    fill_random(psdu, len);
    if (hears()) {
        uint8_t *exact = malloc(len > 0 ? len : 1);
        memcpy(exact, psdu, len);
        const struct tsr_radio_event event = fake_radio_heard(exact, len, fake.now_us);
        tsr_node_on_radio(&fake.node, &event, fake.now_us);
        free(exact);
    }
}

static void random_payload(void)
{
    uint8_t payload[TSR_FRAME_PAYLOAD_MAX];
    const size_t len = roll(TSR_FRAME_PAYLOAD_MAX + 1u);
    fill_random(payload, len);
    if (len > 0 && roll(2) == 0) {
        payload[0] = (uint8_t)(0x10 | roll(2)); /* so that it is a fragment more often */
    }
    if (hears()) {
        fake_node_hear(&fake, (uint16_t)(1 + roll(6)), payload, len);
    }
}

static void random_fragment(void)
{
    uint8_t piece[TSR_FRAGMENT_PIECE_MAX];
    uint8_t payload[TSR_FRAME_PAYLOAD_MAX];
    size_t len = 0;
    struct tsr_fragment fragment = {0};
    fill_random(piece, sizeof piece);
    piece[0] = (uint8_t)(1 + roll(4));
    piece[1] = (uint8_t)(1 + roll(2));
    fragment.poll = roll(2) == 0;
    fragment.ttl = (uint8_t)roll(4);
    fragment.origin = some_address();
    fragment.destination = some_address();
    fragment.message_id = (uint16_t)roll(4);
    fragment.count = (uint16_t)(1 + roll(roll(8) == 0 ? TSR_FRAGMENT_COUNT_MAX : 6));
    fragment.index = (uint16_t)roll(fragment.count);
    fragment.piece = piece;
    fragment.piece_len = (uint8_t)(fragment.index + 1u == fragment.count ? 1 + roll(90) : TSR_FRAGMENT_PIECE_MAX);
    if (tsr_fragment_write(&fragment, payload, sizeof payload, &len) == TSR_OK && hears()) {
        fake_node_hear(&fake, (uint16_t)(1 + roll(6)), payload, len);
    }
}

/* A body that is right for its kind, or nearly. */
static size_t make_body(uint8_t kind, uint8_t *body, size_t cap)
{
    size_t len = roll((uint32_t)cap);
    fill_random(body, len > 8 ? len : 8);
    if (roll(4) == 0) {
        return len;
    }
    if (kind == TSR_MESSAGE_STATUS) {
        struct tsr_body_status status;
        memset(&status, 0, sizeof status);
        status.message_id = roll(3) > 0 ? fake.node.sender.message_id : (uint16_t)roll(0x10000u);
        status.state = (uint8_t)(1 + roll(3));
        status.first = (uint16_t)(8 * roll(4));
        status.bitmap_len = (uint8_t)roll(TSR_BODY_STATUS_BITMAP_MAX + 1u);
        fill_random(status.bitmap, status.bitmap_len);
        (void)tsr_body_write_status(&status, body, cap, &len);
        return len;
    }
    const struct tsr_body_capture capture = {(uint16_t)(fake.node.capture_id + (roll(4) == 0 ? roll(3) : 0)),
                                             (uint8_t)(fake.node.attempt + (roll(4) == 0 ? 1 : 0))};
    tsr_body_write_capture(&capture, body);
    if (kind == TSR_MESSAGE_VIEW && cap > 60) { /* a coded view of the right size, its bits noise */
        const struct tsr_view_info info = {FAKE_WIDTH, FAKE_HEIGHT, 7, true, fake.node.held.full && roll(2) == 0};
        struct tsr_view_held held = fake.node.held; /* a copy: the node's stays as it is */
        static const uint8_t tiles[TSR_VIEW_TILE_COUNT(FAKE_WIDTH, FAKE_HEIGHT)];
        static struct tsr_view_encoder encoder;
        uint8_t scratch[TSR_VIEW_SCRATCH_LEN(FAKE_WIDTH)];
        (void)tsr_view_encode_start(&encoder, &info, info.against_held ? &held : NULL, tiles,
                                    body + TSR_BODY_VIEW_HEADER_LEN, TSR_VIEW_HEADER_LEN_MAX, scratch, sizeof scratch);
        return len > 40 ? len : 40;
    }
    return TSR_BODY_WAKE_LEN;
}

static void random_message(void)
{
    static uint8_t body[1200];
    static uint8_t bytes[1200 + TSR_MESSAGE_OVERHEAD_LEN];
    const uint16_t self = fake.node.config.address;
    struct fake_message message = {(uint8_t)(1 + roll(4)), (uint8_t)(1 + roll(2)), 0, self, body, 0};
    message.origin = message.key_use == TSR_KEY_NODE ? TSR_ADDRESS_SINK : fake.node.config.partner;
    if (roll(8) == 0) {
        message.origin = some_address();
    }
    statuses += message.kind == TSR_MESSAGE_STATUS ? 1 : 0;
    const bool is_long = message.kind == TSR_MESSAGE_VIEW || roll(8) == 0;
    message.body_len = make_body(message.kind, body, is_long ? 1100 : 60);
    uint32_t counter = 0;
    const size_t len = fake_node_seal(&fake, &message, bytes, sizeof bytes, &counter);
    const uint16_t count = tsr_fragment_count(len);
    for (uint16_t i = 0; i < count; i++) {
        if (hears()) {
            fake_node_hear_piece(&fake, message.origin == TSR_ADDRESS_SINK ? FAKE_RELAY : message.origin, &message,
                                 bytes, len, counter, i, i + 1u == count);
        }
        if (roll(4) > 0) {
            (void)fake_node_run(&fake, 3);
        }
    }
}

static void random_port_bytes(void)
{
    uint8_t bytes[TSR_LINK_FRAME_MAX];
    uint8_t body[TSR_LINK_BODY_MAX];
    size_t len = roll(300);
    fill_random(bytes, len);
    if (roll(4) > 0) { /* an ANSWER, often to the frame that waits for it */
        size_t body_len = 0;
        for (uint32_t i = roll(5); i > 0; i--) {
            const struct tsr_fragment fragment = {.ttl = 3,
                                                  .destination = some_address(),
                                                  .count = 1,
                                                  .piece = bytes,
                                                  .piece_len = (uint8_t)(1 + roll(60))};
            size_t fragment_len = 0;
            (void)tsr_fragment_write(&fragment, body + body_len + 1, TSR_FRAME_PAYLOAD_MAX, &fragment_len);
            body[body_len] = (uint8_t)(fragment_len + (roll(8) == 0 ? roll(3) : 0));
            body_len += 1 + fragment_len;
        }
        const uint16_t sequence = roll(4) > 0 ? fake.node.uplink.sequence : (uint16_t)roll(0x10000u);
        const struct tsr_link_frame frame = {(uint8_t)(roll(8) > 0 ? TSR_LINK_ANSWER : 1 + roll(3)), sequence, body,
                                             body_len};
        TEST_ASSERT_EQUAL(TSR_OK, tsr_link_encode(&frame, bytes, sizeof bytes, &len));
    }
    tsr_node_on_port(&fake.node, bytes, len, fake.now_us);
    tsr_node_on_timer(&fake.node, fake.now_us);
}

static void finish_transmission(void)
{
    const enum tsr_radio_outcome outcomes[] = {TSR_RADIO_ACKED,  TSR_RADIO_ACKED,        TSR_RADIO_ACKED,
                                               TSR_RADIO_NO_ACK, TSR_RADIO_CHANNEL_BUSY, TSR_RADIO_FAULT};
    fake_node_transmitted(&fake, outcomes[roll(6)]);
}

static void one_event(void)
{
    fake.radio.on_transmit = roll(50) == 0 ? TSR_ERR_IO : TSR_OK;
    switch (roll(9)) {
    case 0: random_psdu(); break;
    case 1: random_payload(); break;
    case 2: random_fragment(); break;
    case 3:
    case 4: random_message(); break;
    case 5: random_port_bytes(); break;
    case 6: fake_camera_finish(&fake, roll(2) == 0, roll(8) == 0 ? TSR_ERR_IO : TSR_OK); break;
    default: finish_transmission(); break;
    }
    fake.now_us += roll(4) == 0 ? roll(60000) : roll(2000);
    tsr_node_on_timer(&fake.node, fake.now_us);
    (void)fake_node_run(&fake, roll(20));
}

/* Every frame that was heard ends in one of the MAC's counters. */
static void check_mac_counters(void)
{
    const struct tsr_mac_counters *mac = tsr_node_get_mac_counters(&fake.node);
    TEST_ASSERT_EQUAL_MESSAGE(heard,
                              mac->received + mac->dropped_format + mac->dropped_auth + mac->dropped_replay +
                                  mac->dropped_queue + mac->dropped_neighbour,
                              failing);
    TEST_ASSERT_EQUAL_MESSAGE(0, mac->dropped_queue, failing); /* it had stopped to listen */
}

/* A relay does exactly one thing with each frame. */
static void check_relay_counters(void)
{
    const struct tsr_node_counters *node = tsr_node_get_counters(&fake.node);
    const uint32_t explained = node->forwarded + node->dropped_route + node->dropped_format + node->dropped_foreign +
                               node->dropped_auth + node->dropped_replay;
    const uint32_t received = tsr_node_get_mac_counters(&fake.node)->received;
    TEST_ASSERT_LESS_OR_EQUAL_MESSAGE(received, explained, failing);
    TEST_ASSERT_LESS_OR_EQUAL_MESSAGE(statuses, received - explained, failing);
}

/* Everything that is awaited comes, nothing else does: the node comes to rest. */
static void calm_down(void)
{
    fake.radio.on_transmit = TSR_OK;
    const uint64_t end_us = fake.now_us + CALM_US;
    while (fake.now_us < end_us) {
        const unsigned steps = fake_node_run(&fake, STEPS_MAX);
        TEST_ASSERT_LESS_THAN_MESSAGE(STEPS_MAX, steps, failing);
        if (tsr_node_get_phase(&fake.node) <= TSR_PHASE_WATCHING && tsr_node_is_quiet(&fake.node) &&
            !fake.left.pending && !fake.right.pending && !fake.node.wake_due) {
            return;
        }
        fake_node_transmitted(&fake, TSR_RADIO_ACKED);
        fake_camera_finish(&fake, false, TSR_OK);
        fake_camera_finish(&fake, true, TSR_OK);
        if (fake.node.uplink.waiting) {
            uint8_t bytes[TSR_LINK_FRAME_MAX];
            size_t len = 0;
            const struct tsr_link_frame frame = {TSR_LINK_ANSWER, fake.node.uplink.sequence, NULL, 0};
            TEST_ASSERT_EQUAL(TSR_OK, tsr_link_encode(&frame, bytes, sizeof bytes, &len));
            tsr_node_on_port(&fake.node, bytes, len, fake.now_us);
        }
        fake.now_us += 1000;
        tsr_node_on_timer(&fake.node, fake.now_us);
    }
    TEST_FAIL_MESSAGE(failing);
}

/* The smallest sign that the role is still fulfilled. */
static void check_it_works(enum tsr_role role)
{
    const struct tsr_node_counters before = *tsr_node_get_counters(&fake.node);
    const struct tsr_node_counters *after = tsr_node_get_counters(&fake.node);
    uint8_t payload[TSR_FRAME_PAYLOAD_MAX];
    size_t len = 0;
    const struct tsr_fragment up = {.ttl = 9, .origin = 5, .count = 1, .piece = (const uint8_t *)"x", .piece_len = 1};
    switch (role) {
    case TSR_ROLE_GATEWAY:
    case TSR_ROLE_RELAY:
        TEST_ASSERT_EQUAL(TSR_OK, tsr_fragment_write(&up, payload, sizeof payload, &len));
        fake_node_hear(&fake, FAKE_BINOCULAR, payload, len);
        (void)fake_node_run(&fake, STEPS_MAX);
        TEST_ASSERT_EQUAL_MESSAGE(1, after->forwarded + after->uplinks - before.forwarded - before.uplinks, failing);
        break;
    case TSR_ROLE_WING: {
        uint8_t body[TSR_BODY_WAKE_LEN];
        const struct tsr_body_capture capture = {1, 1};
        tsr_body_write_capture(&capture, body);
        const struct fake_message wake = {TSR_MESSAGE_WAKE, TSR_KEY_PAIR, FAKE_LEAD, FAKE_WING, body, sizeof body};
        const unsigned calls = fake.left.calls;
        fake_node_hear_message(&fake, FAKE_LEAD, &wake);
        (void)fake_node_run(&fake, STEPS_MAX);
        fake.now_us += TSR_CAPTURE_DELAY_US;
        (void)fake_node_run(&fake, STEPS_MAX);
        TEST_ASSERT_EQUAL_MESSAGE(calls + 1, fake.left.calls, failing);
        break;
    }
    default: {
        for (unsigned i = 0; i < 10; i++) {
            fake.now_us += 100000;
            (void)fake_node_run(&fake, STEPS_MAX);
            fake_camera_finish(&fake, false, TSR_OK);
            (void)fake_node_run(&fake, STEPS_MAX);
            fake_camera_finish(&fake, true, TSR_OK);
        }
        TEST_ASSERT_GREATER_THAN_MESSAGE(before.frames_watched, after->frames_watched, failing);
    }
    }
}

static void storm(enum tsr_role role, uint64_t seed)
{
    const struct tsr_node_config config = fake_config(role);
    dice = codec_random_of_seed(seed * 8 + role);
    heard = statuses = 0;
    (void)snprintf(failing, sizeof failing, "replay: SEED=%llu RUNS=1 (%s)", (unsigned long long)seed,
                   tsr_role_name(role));
    TEST_ASSERT_EQUAL(TSR_OK, fake_node_start(&fake, &config));
    for (unsigned i = 0; i < EVENTS; i++) {
        one_event();
    }
    check_mac_counters();
    calm_down();
    if (role == TSR_ROLE_RELAY) {
        check_relay_counters();
    }
    check_it_works(role);
    const struct tsr_node_counters *node = tsr_node_get_counters(&fake.node);
    maps += node->maps_made;
    ended += node->maps_sent + node->maps_lost + node->maps_withheld + node->views_sent + node->views_lost;
    fake_node_stop(&fake);
}

#define STORM_TEST(name, role)                                                                                         \
    static void name(void)                                                                                             \
    {                                                                                                                  \
        for (uint64_t seed = first_seed; seed < first_seed + run_count; seed++) {                                      \
            storm(role, seed);                                                                                         \
        }                                                                                                              \
    }

STORM_TEST(test_gateway, TSR_ROLE_GATEWAY)
STORM_TEST(test_relay, TSR_ROLE_RELAY)
STORM_TEST(test_lead, TSR_ROLE_LEAD)
STORM_TEST(test_wing, TSR_ROLE_WING)
STORM_TEST(test_binocular, TSR_ROLE_BINOCULAR)

int main(void)
{
    first_seed = codec_setting("SEED", first_seed);
    run_count = codec_setting("RUNS", run_count);
    UNITY_BEGIN();
    RUN_TEST(test_gateway);
    RUN_TEST(test_relay);
    RUN_TEST(test_lead);
    RUN_TEST(test_wing);
    RUN_TEST(test_binocular);
    printf("%llu maps made, %llu maps and views ended\n", (unsigned long long)maps, (unsigned long long)ended);
    return UNITY_END();
}

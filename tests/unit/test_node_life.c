/*
 * Single nodes, event by event: what a whole site reaches only by chance.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "fake_node.h"
#include "unity.h"

#define STEPS_MAX 5000u

static struct tsr_node_config config;
static struct fake_node fake;

/* What the wing of a lead holds, and whether its next view is against it. */
static uint8_t wing_packed[TSR_VIEW_HELD_LEN(FAKE_WIDTH, FAKE_HEIGHT)];
static struct tsr_view_held wing_held;
static bool against_held;

void setUp(void)
{
    memset(&fake, 0, sizeof fake);
    wing_held = (struct tsr_view_held){.packed = wing_packed, .packed_cap = sizeof wing_packed};
    against_held = false;
}
void tearDown(void)
{
    fake_node_stop(&fake);
}

static void start(enum tsr_role role)
{
    config = fake_config(role);
    TEST_ASSERT_EQUAL(TSR_OK, fake_node_start(&fake, &config));
    (void)fake_node_run(&fake, STEPS_MAX);
}

static const struct tsr_node_counters *counters(void)
{
    return tsr_node_get_counters(&fake.node);
}

/* Run, ending every transmission as acknowledged, until a time; true if the
 * node came to the phase. */
static bool reach(enum tsr_node_phase phase, uint64_t patience_us)
{
    const uint64_t end_us = fake.now_us + patience_us;
    while (fake.now_us < end_us) {
        (void)fake_node_run(&fake, 1);
        if (tsr_node_get_phase(&fake.node) == phase) {
            return true;
        }
        fake.now_us += 200;
        tsr_node_on_timer(&fake.node, fake.now_us);
        fake_node_transmitted(&fake, TSR_RADIO_ACKED);
        fake_camera_finish(&fake, false, TSR_OK);
        fake_camera_finish(&fake, true, TSR_OK);
    }
    return false;
}

static void watch_until(enum tsr_node_phase phase)
{
    TEST_ASSERT_TRUE(reach(phase, 2000000));
}

/* The wing's view of the lead's capture under way: noise, coded. */
static size_t code_view(uint8_t *body, size_t cap)
{
    static struct tsr_view_encoder encoder;
    uint8_t scratch[TSR_VIEW_SCRATCH_LEN(FAKE_WIDTH)];
    uint8_t pixels[FAKE_WIDTH * FAKE_HEIGHT];
    uint8_t tiles[TSR_VIEW_TILE_COUNT(FAKE_WIDTH, FAKE_HEIGHT)] = {1};
    const struct tsr_view_info info = {FAKE_WIDTH, FAKE_HEIGHT, 7, true, against_held};
    const struct tsr_body_capture capture = {fake.node.capture_id, fake.node.attempt};
    size_t len = 0;
    for (unsigned i = 0; i < sizeof pixels; i++) {
        pixels[i] = (uint8_t)(i * i / 7 % 15);
    }
    tsr_body_write_capture(&capture, body);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_encode_start(&encoder, &info, &wing_held, tiles, body + TSR_BODY_VIEW_HEADER_LEN,
                                                    cap - TSR_BODY_VIEW_HEADER_LEN, scratch, sizeof scratch));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_encode_rows(&encoder, pixels, FAKE_WIDTH, FAKE_HEIGHT));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_encode_finish(&encoder, &len));
    return TSR_BODY_VIEW_HEADER_LEN + len;
}

static uint8_t view_body[2048];
static uint8_t view_bytes[2048];
static size_t view_len;
static uint32_t view_counter;
static struct fake_message view;

static void make_view(void)
{
    const struct fake_message message = {TSR_MESSAGE_VIEW, TSR_KEY_PAIR, FAKE_WING,
                                         FAKE_LEAD,        view_body,    code_view(view_body, sizeof view_body)};
    view = message;
    view_len = fake_node_seal(&fake, &view, view_bytes, sizeof view_bytes, &view_counter);
    TEST_ASSERT_GREATER_THAN(0, view_len);
}

static void hear_view(void)
{
    const uint16_t count = tsr_fragment_count(view_len);
    for (uint16_t i = 0; i < count; i++) {
        fake_node_hear_piece(&fake, FAKE_WING, &view, view_bytes, view_len, view_counter, i, i + 1u == count);
        if (i + 1u < count) {
            (void)fake_node_run(&fake, STEPS_MAX);
        }
    }
}

static void hear_status(uint8_t key_use, uint16_t origin, uint16_t message_id, enum tsr_delivery state)
{
    fake_node_hear_status(&fake, key_use, origin, message_id, state);
    (void)fake_node_run(&fake, STEPS_MAX);
}

static void lead_to_sending(void)
{
    start(TSR_ROLE_LEAD);
    watch_until(TSR_PHASE_RECEIVING);
    make_view();
    hear_view();
    watch_until(TSR_PHASE_SENDING);
}

static void test_lead_sends_a_map(void)
{
    lead_to_sending();
    TEST_ASSERT_FALSE(tsr_node_is_quiet(&fake.node));
    (void)reach(TSR_PHASE_IDLE, 300000); /* all fragments out, polled */
    hear_status(TSR_KEY_NODE, TSR_ADDRESS_SINK, fake.node.sender.message_id, TSR_DELIVERY_COMMITTED);
    watch_until(TSR_PHASE_IDLE);
    TEST_ASSERT_EQUAL(1, counters()->maps_sent);
    TEST_ASSERT_TRUE(fake.node.has_last_map);
}

/* A view against one that the lead does not hold is refused, and the lead waits for another. */
static void test_lead_takes_a_view_against_what_it_holds(void)
{
    lead_to_sending();
    (void)reach(TSR_PHASE_IDLE, 300000);
    hear_status(TSR_KEY_NODE, TSR_ADDRESS_SINK, fake.node.sender.message_id, TSR_DELIVERY_COMMITTED);
    watch_until(TSR_PHASE_IDLE);
    watch_until(TSR_PHASE_RECEIVING);
    TEST_ASSERT_EQUAL_HEX16(wing_held.check, fake.node.held.check);
    against_held = true;
    const uint16_t check = wing_held.check;
    wing_held.check ^= 1u;
    make_view();
    hear_view();
    (void)fake_node_run(&fake, STEPS_MAX);
    TEST_ASSERT_EQUAL(TSR_PHASE_RECEIVING, tsr_node_get_phase(&fake.node));
    TEST_ASSERT_EQUAL(1, counters()->dropped_foreign);
    TEST_ASSERT_TRUE(fake.node.held.full && fake.node.held.check == check);
    memcpy(wing_packed, fake.node.held.packed, sizeof wing_packed);
    wing_held.check = check;
    make_view();
    hear_view();
    watch_until(TSR_PHASE_MATCHING);
    TEST_ASSERT_EQUAL_HEX16(wing_held.check, fake.node.held.check);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(wing_packed, fake.node.held.packed, sizeof wing_packed);
}

/* A map belongs to the node and the sink: the wing, whose STATUS is authentic
 * under the pair's key, cannot accept or refuse it. */
static void test_wing_cannot_accept_a_map(void)
{
    lead_to_sending();
    const uint32_t foreign = counters()->dropped_foreign;
    hear_status(TSR_KEY_PAIR, FAKE_WING, fake.node.sender.message_id, TSR_DELIVERY_COMMITTED);
    hear_status(TSR_KEY_PAIR, FAKE_WING, fake.node.sender.message_id, TSR_DELIVERY_REFUSED);
    TEST_ASSERT_EQUAL(TSR_PHASE_SENDING, tsr_node_get_phase(&fake.node));
    TEST_ASSERT_EQUAL(foreign + 2, counters()->dropped_foreign);
    TEST_ASSERT_EQUAL(0, counters()->maps_sent + counters()->maps_lost);
}

/* The message id is that of the sealed message, whatever was sent meanwhile. */
static void test_answer_while_sealing_keeps_the_message_id(void)
{
    start(TSR_ROLE_LEAD);
    watch_until(TSR_PHASE_RECEIVING);
    make_view();
    hear_view();
    watch_until(TSR_PHASE_SEALING);
    const uint16_t last = (uint16_t)(tsr_fragment_count(view_len) - 1u);
    fake_node_hear_piece(&fake, FAKE_WING, &view, view_bytes, view_len, view_counter, last, true); /* polls again */
    watch_until(TSR_PHASE_SENDING);
    uint32_t counter = 0;
    for (unsigned i = 0; i < 4; i++) {
        counter |= (uint32_t)fake.node.message[2 + i] << (8 * i);
    }
    TEST_ASSERT_EQUAL_HEX16((uint16_t)counter, fake.node.sender.message_id);
}

/* The wing's camera may be faster than the lead's. */
static void test_early_view_is_not_refused(void)
{
    start(TSR_ROLE_LEAD);
    while (tsr_node_get_phase(&fake.node) != TSR_PHASE_CAPTURING) {
        fake.now_us += 200;
        tsr_node_on_timer(&fake.node, fake.now_us);
        fake_node_transmitted(&fake, TSR_RADIO_ACKED);
        if (tsr_node_get_phase(&fake.node) == TSR_PHASE_WATCHING) {
            fake_camera_finish(&fake, false, TSR_OK);
        }
        (void)fake_node_run(&fake, 1);
    }
    make_view();
    hear_view();
    (void)fake_node_run(&fake, STEPS_MAX);
    TEST_ASSERT_EQUAL(TSR_MAC_QUEUE_LEN, tsr_mac_room(&fake.node.mac)); /* no REFUSED goes out */
    TEST_ASSERT_EQUAL(tsr_fragment_count(view_len), counters()->dropped_foreign);
    watch_until(TSR_PHASE_RECEIVING);
    hear_view();
    watch_until(TSR_PHASE_SENDING);
}

/* What comes between the last fragment and the next step takes nothing back. */
static void test_contradiction_after_the_last_fragment(void)
{
    start(TSR_ROLE_LEAD);
    watch_until(TSR_PHASE_RECEIVING);
    make_view();
    const uint16_t count = tsr_fragment_count(view_len);
    for (uint16_t i = 0; i + 1u < count; i++) {
        fake_node_hear_piece(&fake, FAKE_WING, &view, view_bytes, view_len, view_counter, i, false);
        (void)fake_node_run(&fake, STEPS_MAX);
    }
    hear_view();
    fake_node_hear_piece(&fake, FAKE_WING, &view, view_bytes, view_len + 500, view_counter, 0, false);
    (void)fake_node_run(&fake, 2); /* both frames, no stage yet */
    TEST_ASSERT_EQUAL(1, counters()->dropped_format);
    watch_until(TSR_PHASE_SENDING);
}

static void wing_hears_wake(uint8_t key_use, uint16_t origin, uint16_t capture_id, uint8_t attempt)
{
    uint8_t body[TSR_BODY_WAKE_LEN];
    const struct tsr_body_capture capture = {capture_id, attempt};
    tsr_body_write_capture(&capture, body);
    const struct fake_message message = {TSR_MESSAGE_WAKE, key_use, origin, FAKE_WING, body, sizeof body};
    fake_node_hear_message(&fake, FAKE_LEAD, &message);
    (void)fake_node_run(&fake, 1); /* the frame only */
}

/* The first byte of the view being sent next, while it is plain: 0x01 on its own, 0x11 against the held one. */
static uint8_t wing_codes_view(uint16_t capture_id)
{
    wing_hears_wake(TSR_KEY_PAIR, FAKE_LEAD, capture_id, 1);
    TEST_ASSERT_TRUE(reach(TSR_PHASE_CAPTURING, 100000));
    TEST_ASSERT_TRUE(reach(TSR_PHASE_SEALING, 100000));
    const uint8_t *coded = fake.node.message + TSR_MESSAGE_HEADER_LEN + TSR_BODY_VIEW_HEADER_LEN;
    TEST_ASSERT_EQUAL_HEX8(0x1f, coded[1]);
    return coded[0];
}

static void wing_is_answered(enum tsr_delivery state)
{
    TEST_ASSERT_TRUE(reach(TSR_PHASE_SENDING, 100000));
    (void)reach(TSR_PHASE_IDLE, 100000); /* all fragments out, polled */
    hear_status(TSR_KEY_PAIR, FAKE_LEAD, fake.node.sender.message_id, state);
    TEST_ASSERT_TRUE(reach(TSR_PHASE_IDLE, 100000));
}

/* Against the last view only once the lead is known to have it. */
static void test_wing_refers_to_what_was_accepted(void)
{
    start(TSR_ROLE_WING);
    TEST_ASSERT_EQUAL_HEX8(0x01, wing_codes_view(1));
    wing_is_answered(TSR_DELIVERY_COMMITTED);
    const uint16_t check = fake.node.held.check;
    TEST_ASSERT_EQUAL_HEX8(0x11, wing_codes_view(2));
    const uint8_t *coded = fake.node.message + TSR_MESSAGE_HEADER_LEN + TSR_BODY_VIEW_HEADER_LEN;
    TEST_ASSERT_EQUAL_HEX16(check, coded[6] | coded[7] << 8);
    wing_is_answered(TSR_DELIVERY_COMMITTED);
    TEST_ASSERT_EQUAL_HEX8(0x11, wing_codes_view(3));
    wing_is_answered(TSR_DELIVERY_REFUSED);
    TEST_ASSERT_EQUAL_HEX8(0x01, wing_codes_view(4));
    wing_hears_wake(TSR_KEY_PAIR, FAKE_LEAD, 5, 1); /* the view under way is dropped */
    (void)fake_node_run(&fake, STEPS_MAX);
    TEST_ASSERT_EQUAL_HEX8(0x01, wing_codes_view(5));
    TEST_ASSERT_EQUAL(2, counters()->views_sent);
    TEST_ASSERT_EQUAL(2, counters()->views_lost);
}

/* Later attempts replace the earlier one until the camera is ordered, 1 ms before the instant. */
static void test_wing_captures_at_the_last_attempt(void)
{
    start(TSR_ROLE_WING);
    const uint64_t first_us = fake.now_us;
    wing_hears_wake(TSR_KEY_PAIR, FAKE_LEAD, 1, 1);
    TEST_ASSERT_EQUAL_UINT64(first_us + TSR_CAPTURE_DELAY_US - TSR_CAPTURE_ORDER_US,
                             tsr_node_step(&fake.node, fake.now_us).wake_us);
    TEST_ASSERT_EQUAL(0, fake.left.calls);
    fake.now_us += 15000;
    (void)fake_node_run(&fake, STEPS_MAX);
    wing_hears_wake(TSR_KEY_PAIR, FAKE_LEAD, 1, 2);
    fake.now_us = first_us + TSR_CAPTURE_DELAY_US; /* the first instant passes */
    (void)fake_node_run(&fake, STEPS_MAX);
    TEST_ASSERT_EQUAL(0, fake.left.calls);
    fake.now_us = first_us + 15000 + TSR_CAPTURE_DELAY_US - TSR_CAPTURE_ORDER_US;
    (void)fake_node_run(&fake, STEPS_MAX);
    TEST_ASSERT_EQUAL(1, fake.left.calls);
    TEST_ASSERT_EQUAL_UINT64(first_us + 15000 + TSR_CAPTURE_DELAY_US, fake.left.at_us);
    TEST_ASSERT_EQUAL(2, fake.node.attempt);
}

/* A view of another instant is worse than none. */
static void test_wing_too_late_does_not_capture(void)
{
    start(TSR_ROLE_WING);
    wing_hears_wake(TSR_KEY_PAIR, FAKE_LEAD, 1, 1);
    fake.now_us += TSR_CAPTURE_DELAY_US + TSR_CAPTURE_ORDER_US + 1;
    (void)fake_node_run(&fake, STEPS_MAX);
    TEST_ASSERT_EQUAL(0, fake.left.calls);
    TEST_ASSERT_EQUAL(1, counters()->captures_failed);
    wing_hears_wake(TSR_KEY_PAIR, FAKE_LEAD, 2, 1);
    TEST_ASSERT_TRUE(reach(TSR_PHASE_SENDING, 100000));
}

static void test_wing_obeys_its_lead_alone(void)
{
    start(TSR_ROLE_WING);
    wing_hears_wake(TSR_KEY_NODE, TSR_ADDRESS_SINK, 1, 1);
    wing_hears_wake(TSR_KEY_PAIR, FAKE_BINOCULAR, 1, 1);
    TEST_ASSERT_EQUAL(2, counters()->dropped_foreign);
    fake.message_counter -= 2;
    wing_hears_wake(TSR_KEY_PAIR, FAKE_LEAD, 1, 1);
    TEST_ASSERT_TRUE(fake.node.wake_due);
    fake.node.wake_due = false;
    fake.message_counter -= 1; /* the same message again in another frame */
    wing_hears_wake(TSR_KEY_PAIR, FAKE_LEAD, 1, 1);
    TEST_ASSERT_FALSE(fake.node.wake_due);
    TEST_ASSERT_EQUAL(1, counters()->dropped_replay);
}

/* Each view ends in exactly one counter, in whatever phase a new WAKE meets it. */
static void test_every_dropped_view_is_counted(void)
{
    const enum tsr_node_phase phases[] = {TSR_PHASE_ENCODING, TSR_PHASE_SEALING, TSR_PHASE_SENDING};
    start(TSR_ROLE_WING);
    for (uint16_t i = 0; i < 3; i++) {
        wing_hears_wake(TSR_KEY_PAIR, FAKE_LEAD, (uint16_t)(1 + i), 1);
        TEST_ASSERT_TRUE(reach(TSR_PHASE_CAPTURING, 100000));
        TEST_ASSERT_TRUE(reach(phases[i], 100000));
        TEST_ASSERT_EQUAL(i, counters()->views_lost);
        wing_hears_wake(TSR_KEY_PAIR, FAKE_LEAD, (uint16_t)(1 + i), 2);
        (void)fake_node_run(&fake, STEPS_MAX);
        TEST_ASSERT_EQUAL(i + 1, counters()->views_lost);
        fake.node.wake_due = false;
    }
    /* Accepted in the same step as the new WAKE: not lost. */
    wing_hears_wake(TSR_KEY_PAIR, FAKE_LEAD, 9, 1);
    TEST_ASSERT_TRUE(reach(TSR_PHASE_SENDING, 200000));
    (void)reach(TSR_PHASE_IDLE, 100000);
    struct tsr_body_status status;
    memset(&status, 0, sizeof status);
    status.message_id = fake.node.sender.message_id;
    status.state = TSR_DELIVERY_COMMITTED;
    tsr_sender_on_status(&fake.node.sender, &status, fake.now_us);
    wing_hears_wake(TSR_KEY_PAIR, FAKE_LEAD, 10, 1);
    (void)fake_node_run(&fake, STEPS_MAX);
    TEST_ASSERT_EQUAL(3, counters()->views_lost);
    TEST_ASSERT_EQUAL(1, counters()->views_sent);
}

/* A map of pure noise outgrows the longest message: it is lost, the node is not. */
static void test_map_too_long_for_a_message(void)
{
    config = fake_config(TSR_ROLE_BINOCULAR);
    config.change.width = config.match.width = config.similarity.width = 480;
    config.change.height = config.match.height = config.similarity.height = 360;
    config.match.uniqueness_percent = config.match.texture_min = config.match.lr_tolerance_px = TSR_MATCH_TEST_OFF;
    config.step_log2 = 0;
    config.rows_per_step = 255;
    enum tsr_status started = fake_node_start(&fake, &config);
    if (started == TSR_ERR_NOBUF) {
        TEST_IGNORE_MESSAGE("this machine has no room for a 640x480 arena");
    }
    TEST_ASSERT_EQUAL(TSR_OK, started);
    TEST_ASSERT_TRUE(reach(TSR_PHASE_ENCODING, 1000000));
    for (unsigned i = 0; i < 20 && tsr_node_get_phase(&fake.node) == TSR_PHASE_ENCODING; i++) {
        (void)fake_node_run(&fake, 1);
    }
    TEST_ASSERT_EQUAL_STRING("idle", tsr_phase_name(tsr_node_get_phase(&fake.node)));
    TEST_ASSERT_EQUAL(1, counters()->maps_lost);
}

/* No counter comes twice: with the last one used the node falls silent. */
static void test_message_counters_never_wrap(void)
{
    config = fake_config(TSR_ROLE_LEAD);
    config.counter_start = UINT32_MAX - 1;
    TEST_ASSERT_EQUAL(TSR_OK, fake_node_start(&fake, &config));
    (void)reach(TSR_PHASE_SENDING, 12000000); /* it waits 8 s for the view of its only WAKE */
    TEST_ASSERT_EQUAL_HEX32(UINT32_MAX, fake.node.message_counter);
    TEST_ASSERT_GREATER_THAN(3, counters()->captures_failed);
    TEST_ASSERT_GREATER_THAN(5, counters()->frames_watched);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_lead_sends_a_map);
    RUN_TEST(test_lead_takes_a_view_against_what_it_holds);
    RUN_TEST(test_wing_cannot_accept_a_map);
    RUN_TEST(test_answer_while_sealing_keeps_the_message_id);
    RUN_TEST(test_early_view_is_not_refused);
    RUN_TEST(test_contradiction_after_the_last_fragment);
    RUN_TEST(test_wing_refers_to_what_was_accepted);
    RUN_TEST(test_wing_captures_at_the_last_attempt);
    RUN_TEST(test_wing_too_late_does_not_capture);
    RUN_TEST(test_wing_obeys_its_lead_alone);
    RUN_TEST(test_every_dropped_view_is_counted);
    RUN_TEST(test_map_too_long_for_a_message);
    RUN_TEST(test_message_counters_never_wrap);
    return UNITY_END();
}

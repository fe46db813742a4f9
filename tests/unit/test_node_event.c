/*
 * Depth rules of one node: what becomes an EVENT, and what a lost one does.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "fake_node.h"
#include "unity.h"

#define STEPS_MAX 5000u
#define LIMIT_Q4 96u /* 6 px */
#define NEAR_PX 9u
#define FAR_PX 3u
#define ZONE_PX 240u                          /* 20 x 12 */
#define SCALE_Q8 (2000u * 100u * UINT32_C(9)) /* so that 9 px (2304 in UQ8.8) are 781 mm */

static struct tsr_node_config config;
static struct tsr_depth_rule rules[2];
static struct fake_node fake;
static unsigned scene;    /* another one is a change of the picture */
static unsigned shift_px; /* the disparity of all of it */

void setUp(void)
{
    const struct tsr_rectangle part = {10, 6, 20, 12};
    memset(&fake, 0, sizeof fake);
    memset(rules, 0, sizeof rules);
    rules[0].zone = (struct tsr_zone_config){.part = part, .kind = TSR_ZONE_NEARER, .limit_q4 = LIMIT_Q4};
    rules[0].begin_px = ZONE_PX / 2;
    rules[0].end_px = ZONE_PX / 4;
    rules[1].zone = (struct tsr_zone_config){.part = part, .kind = TSR_ZONE_SURFACE};
    rules[1].begin_px = ZONE_PX / 2;
    rules[1].scale_q8 = SCALE_Q8;
    rules[1].change_mm = 100;
    config = fake_config(TSR_ROLE_BINOCULAR);
    config.rules = rules;
    scene = 1;
    shift_px = FAR_PX;
}
void tearDown(void)
{
    fake_node_stop(&fake);
}

static uint8_t pattern(unsigned x, unsigned y)
{
    uint32_t mixed = (x * 2654435761u) ^ (y * 40503u) ^ (scene * 2246822519u);
    mixed ^= mixed >> 15;
    mixed *= 2246822519u;
    return (uint8_t)(mixed >> 24);
}

static void finish_camera(bool right)
{
    struct fake_camera *camera = right ? &fake.right : &fake.left;
    if (!camera->pending) {
        return;
    }
    for (unsigned y = 0; y < camera->image.height; y++) {
        for (unsigned x = 0; x < camera->image.width; x++) {
            camera->image.pixels[y * camera->image.stride + x] = pattern(x + (right ? shift_px : 0), y);
        }
    }
    camera->pending = false;
    tsr_node_on_camera(&fake.node, right, TSR_OK, camera->at_us > fake.now_us ? camera->at_us : fake.now_us);
}

/* Run until the node comes to the phase; every transmission is acknowledged. */
static void reach(enum tsr_node_phase phase, uint64_t patience_us)
{
    const uint64_t end_us = fake.now_us + patience_us;
    while (fake.now_us < end_us) {
        (void)fake_node_run(&fake, 1);
        if (tsr_node_get_phase(&fake.node) == phase) {
            return;
        }
        fake.now_us += 200;
        tsr_node_on_timer(&fake.node, fake.now_us);
        fake_node_transmitted(&fake, TSR_RADIO_ACKED);
        finish_camera(false);
        finish_camera(true);
    }
    TEST_ASSERT_EQUAL_STRING(tsr_phase_name(phase), tsr_phase_name(tsr_node_get_phase(&fake.node)));
}

static void answer(enum tsr_delivery state)
{
    uint8_t body[TSR_BODY_STATUS_MAX];
    size_t len = 0;
    struct tsr_body_status status;
    memset(&status, 0, sizeof status);
    status.message_id = fake.node.sender.message_id;
    status.state = (uint8_t)state;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_body_write_status(&status, body, sizeof body, &len));
    const struct fake_message message = {TSR_MESSAGE_STATUS, TSR_KEY_NODE, TSR_ADDRESS_SINK, FAKE_BINOCULAR, body, len};
    fake_node_hear_message(&fake, FAKE_RELAY, &message);
}

/* Let what is being sent go out, then answer it. */
static void end_sending(enum tsr_delivery state)
{
    for (unsigned i = 0; i < 1000; i++) {
        (void)fake_node_run(&fake, STEPS_MAX);
        fake.now_us += 200;
        tsr_node_on_timer(&fake.node, fake.now_us);
        fake_node_transmitted(&fake, TSR_RADIO_ACKED);
    }
    answer(state);
}

static void start(void)
{
    TEST_ASSERT_EQUAL(TSR_OK, fake_node_start(&fake, &config));
}

static void show(unsigned disparity_px)
{
    scene++;
    shift_px = disparity_px;
}

/* The EVENT message under way, opened as the sink does. */
static struct tsr_body_events sent_events(void)
{
    const struct tsr_cipher cipher = test_cipher(20);
    uint8_t message[TSR_FRAGMENT_PIECE_MAX];
    struct tsr_message_header header;
    struct tsr_body_events events;
    size_t body_len = 0;
    const size_t len = fake.node.sender.message_len;
    TEST_ASSERT_LESS_OR_EQUAL(sizeof message, len);
    memcpy(message, fake.node.sender.message, len);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_message_parse(message, len, FAKE_BINOCULAR, TSR_ADDRESS_SINK, &header));
    TEST_ASSERT_EQUAL(TSR_MESSAGE_EVENT, header.kind);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_message_open(&header, &cipher, message, len, &body_len));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_body_read_events(message + TSR_MESSAGE_HEADER_LEN, body_len, &events));
    TEST_ASSERT_EQUAL_UINT64(fake.node.capture_time_us, events.capture_time_us);
    TEST_ASSERT_EQUAL(fake.node.capture_id, events.capture_id);
    return events;
}

static void expect_event(const struct tsr_body_events *events, unsigned at, uint8_t rule, enum tsr_event_kind kind,
                         unsigned disparity_px)
{
    TEST_ASSERT_GREATER_THAN(at, events->count);
    TEST_ASSERT_EQUAL(rule, events->events[at].rule);
    TEST_ASSERT_EQUAL(kind, events->events[at].kind);
    if (kind == TSR_EVENT_BEGUN || kind == TSR_EVENT_MEASURED) {
        TEST_ASSERT_UINT16_WITHIN(64, 256u * disparity_px, events->events[at].disparity_q8);
        TEST_ASSERT_GREATER_THAN(TSR_EVENT_SHARE_ONE / 2, events->events[at].share_q12);
    }
}

/* The events, committed, then the map, committed. */
static struct tsr_body_events deliver(void)
{
    reach(TSR_PHASE_NOTIFYING, 2000000);
    (void)fake_node_run(&fake, STEPS_MAX);
    const struct tsr_body_events events = sent_events();
    end_sending(TSR_DELIVERY_COMMITTED);
    reach(TSR_PHASE_SENDING, 2000000);
    end_sending(TSR_DELIVERY_COMMITTED);
    reach(TSR_PHASE_IDLE, 100000);
    return events;
}

static void deliver_map_alone(void)
{
    reach(TSR_PHASE_SENDING, 2000000);
    end_sending(TSR_DELIVERY_COMMITTED);
    reach(TSR_PHASE_IDLE, 100000);
}

/* Alike the last one the sink has, and nothing new to the rules. */
static void expect_withheld(void)
{
    const struct tsr_node_counters before = *tsr_node_get_counters(&fake.node);
    reach(TSR_PHASE_COMPARING, 2000000);
    reach(TSR_PHASE_IDLE, 100000);
    TEST_ASSERT_EQUAL(before.maps_withheld + 1, tsr_node_get_counters(&fake.node)->maps_withheld);
    TEST_ASSERT_EQUAL(before.events_sent, tsr_node_get_counters(&fake.node)->events_sent);
}

static void test_begins_and_ends(void)
{
    config.rule_count = 1;
    start();
    deliver_map_alone(); /* far: nothing has begun */
    show(NEAR_PX);
    struct tsr_body_events events = deliver();
    TEST_ASSERT_EQUAL(1, events.count);
    expect_event(&events, 0, 0, TSR_EVENT_BEGUN, NEAR_PX);
    show(NEAR_PX + 2);
    deliver_map_alone(); /* still begun */
    show(FAR_PX);
    events = deliver();
    TEST_ASSERT_EQUAL(1, events.count);
    expect_event(&events, 0, 0, TSR_EVENT_ENDED, 0);
    TEST_ASSERT_EQUAL(2, tsr_node_get_counters(&fake.node)->events_sent);
    TEST_ASSERT_EQUAL(4, tsr_node_get_counters(&fake.node)->maps_sent);
}

static void test_surface_is_measured_when_it_moves(void)
{
    config.rules = &rules[1];
    config.rule_count = 1;
    start();
    struct tsr_body_events events = deliver(); /* its first depth */
    expect_event(&events, 0, 0, TSR_EVENT_MEASURED, FAR_PX);
    show(NEAR_PX); /* 781 mm */
    events = deliver();
    expect_event(&events, 0, 0, TSR_EVENT_MEASURED, NEAR_PX);
    show(NEAR_PX + 1); /* 703 mm: moved by less than 100 */
    expect_withheld();
    show(NEAR_PX + 2); /* 639 mm, by 142 from what was reported */
    events = deliver();
    expect_event(&events, 0, 0, TSR_EVENT_MEASURED, NEAR_PX + 2);
    config.rule_count = 0;
}

static void test_two_rules_in_one_message(void)
{
    config.rule_count = 2;
    shift_px = NEAR_PX;
    start();
    const struct tsr_body_events events = deliver();
    TEST_ASSERT_EQUAL(2, events.count);
    expect_event(&events, 0, 0, TSR_EVENT_BEGUN, NEAR_PX);
    expect_event(&events, 1, 1, TSR_EVENT_MEASURED, NEAR_PX);
    TEST_ASSERT_EQUAL(2, tsr_node_get_counters(&fake.node)->events_sent);
}

/* The sink never answers: the map goes all the same, and the next one is judged as if nothing had been said. */
static void test_lost_event_is_judged_again(void)
{
    config.rule_count = 1;
    shift_px = NEAR_PX;
    start();
    reach(TSR_PHASE_NOTIFYING, 2000000);
    reach(TSR_PHASE_SENDING, 120000000);
    TEST_ASSERT_EQUAL(0, tsr_node_get_counters(&fake.node)->events_sent);
    TEST_ASSERT_EQUAL(1, tsr_node_get_counters(&fake.node)->events_lost);
    end_sending(TSR_DELIVERY_COMMITTED);
    reach(TSR_PHASE_IDLE, 100000);
    reach(TSR_PHASE_NOTIFYING, 2000000); /* without a change */
    (void)fake_node_run(&fake, STEPS_MAX);
    const struct tsr_body_events events = sent_events();
    expect_event(&events, 0, 0, TSR_EVENT_BEGUN, NEAR_PX);
    end_sending(TSR_DELIVERY_COMMITTED);
    reach(TSR_PHASE_IDLE, 1000000); /* the map is withheld: it is the same */
    TEST_ASSERT_EQUAL(1, tsr_node_get_counters(&fake.node)->events_sent);
    TEST_ASSERT_EQUAL(1, tsr_node_get_counters(&fake.node)->maps_withheld);
}

/* A sink with another site.toml: sending it again is no use. */
static void test_refused_event_is_not_repeated(void)
{
    config.rule_count = 1;
    shift_px = NEAR_PX;
    start();
    reach(TSR_PHASE_NOTIFYING, 2000000);
    end_sending(TSR_DELIVERY_REFUSED);
    reach(TSR_PHASE_SENDING, 1000000);
    end_sending(TSR_DELIVERY_COMMITTED);
    reach(TSR_PHASE_IDLE, 100000);
    TEST_ASSERT_EQUAL(1, tsr_node_get_counters(&fake.node)->events_lost);
    TEST_ASSERT_FALSE(fake.node.recapture);
    show(NEAR_PX + 1);
    expect_withheld();
}

/* No counter comes twice: without one the event is lost, and the node goes on. */
static void test_no_counter_left(void)
{
    config.rule_count = 1;
    config.counter_start = UINT32_MAX;
    shift_px = NEAR_PX;
    start();
    reach(TSR_PHASE_NOTIFYING, 2000000);
    reach(TSR_PHASE_IDLE, 1000000);
    TEST_ASSERT_EQUAL(1, tsr_node_get_counters(&fake.node)->events_lost);
    TEST_ASSERT_EQUAL(1, tsr_node_get_counters(&fake.node)->maps_lost);
}

static void refuse(const char *expected)
{
    const char *field = NULL;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_node_check(&config, &field));
    TEST_ASSERT_EQUAL_STRING(expected, field);
    setUp();
    config.rule_count = 2;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_node_check(&config, &field));
}

static void test_rules_are_checked(void)
{
    config.rule_count = TSR_DEPTH_RULES_MAX + 1;
    refuse("rule_count");
    rules[0].zone.kind = 0;
    refuse("rules.zone");
    rules[1].zone.kind = TSR_ZONE_SURFACE + 1;
    refuse("rules.zone");
    rules[1].zone.part.x = FAKE_WIDTH - 19;
    refuse("rules.zone");
    rules[0].begin_px = 0;
    refuse("rules.begin_px");
    rules[0].begin_px = ZONE_PX + 1;
    refuse("rules.begin_px");
    rules[0].end_px = 0;
    refuse("rules.end_px");
    rules[0].end_px = rules[0].begin_px + 1;
    refuse("rules.end_px");
    rules[1].scale_q8 = 0;
    refuse("rules.scale_q8");
    rules[1].change_mm = 0;
    refuse("rules.change_mm");
    config.rules = NULL;
    refuse("rules");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_begins_and_ends);
    RUN_TEST(test_surface_is_measured_when_it_moves);
    RUN_TEST(test_two_rules_in_one_message);
    RUN_TEST(test_lost_event_is_judged_again);
    RUN_TEST(test_refused_event_is_not_repeated);
    RUN_TEST(test_no_counter_left);
    RUN_TEST(test_rules_are_checked);
    return UNITY_END();
}

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

static void pass(uint64_t time_us)
{
    fake.now_us += time_us;
    tsr_node_on_timer(&fake.node, fake.now_us);
    fake_node_transmitted(&fake, TSR_RADIO_ACKED);
    finish_camera(false);
    finish_camera(true);
}

static bool notice_is_under_way(void)
{
    return fake.node.notice.under_way;
}

static bool map_is_under_way(void)
{
    return fake.node.map_under_way;
}

static bool event_is_lost(void)
{
    return tsr_node_get_counters(&fake.node)->events_lost > 0;
}

static bool is_watching(void)
{
    return tsr_node_get_phase(&fake.node) == TSR_PHASE_WATCHING;
}

/* Step by step until it is so; every transmission is acknowledged. */
static void run_until(bool (*is_so)(void), uint64_t patience_us)
{
    const uint64_t end_us = fake.now_us + patience_us;
    for (; fake.now_us < end_us && !is_so(); pass(200)) {
        for (unsigned i = 0; i < STEPS_MAX && !is_so(); i++) {
            if (fake_node_run(&fake, 1) == 1 && tsr_node_step(&fake.node, fake.now_us).work == TSR_WORK_NONE) {
                break;
            }
        }
    }
    TEST_ASSERT_TRUE(is_so());
}

/* Nothing but time. */
static void run_for(uint64_t time_us)
{
    const uint64_t end_us = fake.now_us + time_us;
    for (; fake.now_us < end_us; pass(200)) {
        (void)fake_node_run(&fake, STEPS_MAX);
    }
}

static void answer(uint16_t message_id, enum tsr_delivery state)
{
    fake_node_hear_status(&fake, TSR_KEY_NODE, TSR_ADDRESS_SINK, message_id, state);
    pass(200);
    (void)fake_node_run(&fake, 4);
}

static void answer_notice(enum tsr_delivery state)
{
    run_for(10000); /* its frame is out */
    answer(fake.node.notice.sender.message_id, state);
    TEST_ASSERT_FALSE(notice_is_under_way());
}

static void answer_map(enum tsr_delivery state)
{
    run_until(map_is_under_way, 2000000);
    run_for(20000);
    answer(fake.node.sender.message_id, state);
    TEST_ASSERT_FALSE(map_is_under_way());
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
    const size_t len = fake.node.notice.sender.message_len;
    TEST_ASSERT_LESS_OR_EQUAL(sizeof message, len);
    memcpy(message, fake.node.notice.sender.message, len);
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
    run_until(notice_is_under_way, 2000000);
    const struct tsr_body_events events = sent_events();
    answer_notice(TSR_DELIVERY_COMMITTED);
    answer_map(TSR_DELIVERY_COMMITTED);
    return events;
}

static void deliver_map_alone(void)
{
    answer_map(TSR_DELIVERY_COMMITTED);
    TEST_ASSERT_FALSE(notice_is_under_way());
}

/* Alike the last one the sink has, and nothing new to the rules. */
static void expect_withheld(void)
{
    const struct tsr_node_counters before = *tsr_node_get_counters(&fake.node);
    run_for(300000);
    TEST_ASSERT_EQUAL(before.maps_withheld + 1, tsr_node_get_counters(&fake.node)->maps_withheld);
    TEST_ASSERT_EQUAL(before.events_sent, tsr_node_get_counters(&fake.node)->events_sent);
    TEST_ASSERT_FALSE(notice_is_under_way());
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
    show(NEAR_PX + 3);
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

/* The event is in the MAC's queue before a byte of the map is coded. */
static void test_event_goes_before_the_map(void)
{
    config.rule_count = 1;
    shift_px = NEAR_PX;
    start();
    run_until(notice_is_under_way, 2000000);
    TEST_ASSERT_EQUAL_STRING("comparing", tsr_phase_name(tsr_node_get_phase(&fake.node)));
    (void)tsr_node_step(&fake.node, fake.now_us);
    TEST_ASSERT_EQUAL(1, fake.node.notice.sender.counters.fragments);
}

/* Somebody passes while a map is on its way: an event, and then a map of what is there. */
static void test_watches_while_its_map_is_under_way(void)
{
    config.rule_count = 1;
    start();
    run_until(map_is_under_way, 2000000);
    const uint16_t map_id = fake.node.sender.message_id;
    show(NEAR_PX);
    run_until(notice_is_under_way, 300000);
    TEST_ASSERT_TRUE(map_is_under_way());
    const struct tsr_body_events events = sent_events();
    expect_event(&events, 0, 0, TSR_EVENT_BEGUN, NEAR_PX);
    answer_notice(TSR_DELIVERY_COMMITTED);
    run_for(1000);
    TEST_ASSERT_EQUAL(1, tsr_node_get_counters(&fake.node)->maps_measured);
    TEST_ASSERT_EQUAL(map_id, fake.node.sender.message_id);
    answer(map_id, TSR_DELIVERY_COMMITTED);
    answer_map(TSR_DELIVERY_COMMITTED); /* of the next look, without a change */
    TEST_ASSERT_EQUAL(2, tsr_node_get_counters(&fake.node)->maps_sent);
    const struct tsr_node_counters *counters = tsr_node_get_counters(&fake.node);
    TEST_ASSERT_EQUAL(counters->maps_made, counters->maps_sent + counters->maps_withheld + counters->maps_measured);
}

/* What moves without a change of the picture is measured all the same; then a map of it is made. */
static void test_measures_without_a_change(void)
{
    config.rule_count = 1;
    config.measure_period_us = 300000;
    start();
    deliver_map_alone();
    run_for(400000);
    TEST_ASSERT_EQUAL(1, tsr_node_get_counters(&fake.node)->maps_measured);
    TEST_ASSERT_EQUAL(1, tsr_node_get_counters(&fake.node)->maps_made - tsr_node_get_counters(&fake.node)->maps_sent);
    shift_px = NEAR_PX; /* the left view is the same */
    const struct tsr_body_events events = deliver();
    expect_event(&events, 0, 0, TSR_EVENT_BEGUN, NEAR_PX);
    TEST_ASSERT_EQUAL(2, tsr_node_get_counters(&fake.node)->maps_sent);
    fake_node_stop(&fake);
    config.measure_period_us = 0; /* without it nobody looks */
    shift_px = FAR_PX;
    start();
    deliver_map_alone();
    shift_px = NEAR_PX;
    run_for(1000000);
    TEST_ASSERT_EQUAL(1, tsr_node_get_counters(&fake.node)->maps_made);
}

/* The place of the last map was taken by one that the sink does not have: the next is sent, however similar. */
static void test_map_lost_while_watching(void)
{
    config.rule_count = 1;
    start();
    answer_map(TSR_DELIVERY_COMMITTED);
    show(FAR_PX + 3);
    answer_map(TSR_DELIVERY_REFUSED);
    TEST_ASSERT_EQUAL(1, tsr_node_get_counters(&fake.node)->maps_lost);
    TEST_ASSERT_FALSE(fake.node.has_last_map);
    answer_map(TSR_DELIVERY_COMMITTED);
    TEST_ASSERT_EQUAL(2, tsr_node_get_counters(&fake.node)->maps_sent);
}

/* The sink never answers: the next map is judged as if nothing had been said. */
static void test_lost_event_is_judged_again(void)
{
    config.rule_count = 1;
    shift_px = NEAR_PX;
    start();
    run_until(notice_is_under_way, 2000000);
    answer_map(TSR_DELIVERY_COMMITTED);
    run_until(event_is_lost, 120000000);
    TEST_ASSERT_EQUAL(0, tsr_node_get_counters(&fake.node)->events_sent);
    TEST_ASSERT_EQUAL(1, tsr_node_get_counters(&fake.node)->events_lost);
    run_until(notice_is_under_way, 2000000); /* without a change */
    const struct tsr_body_events events = sent_events();
    expect_event(&events, 0, 0, TSR_EVENT_BEGUN, NEAR_PX);
    answer_notice(TSR_DELIVERY_COMMITTED);
    run_for(200000); /* the map is withheld: it is the same */
    TEST_ASSERT_EQUAL(1, tsr_node_get_counters(&fake.node)->events_sent);
    TEST_ASSERT_EQUAL(1, tsr_node_get_counters(&fake.node)->maps_sent);
}

/* A sink with another site.toml: sending it again is no use. */
static void test_refused_event_is_not_repeated(void)
{
    config.rule_count = 1;
    shift_px = NEAR_PX;
    start();
    run_until(notice_is_under_way, 2000000);
    answer_notice(TSR_DELIVERY_REFUSED);
    answer_map(TSR_DELIVERY_COMMITTED);
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
    run_until(event_is_lost, 2000000);
    TEST_ASSERT_FALSE(notice_is_under_way());
    run_until(is_watching, 1000000);
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
    RUN_TEST(test_event_goes_before_the_map);
    RUN_TEST(test_watches_while_its_map_is_under_way);
    RUN_TEST(test_measures_without_a_change);
    RUN_TEST(test_map_lost_while_watching);
    RUN_TEST(test_lost_event_is_judged_again);
    RUN_TEST(test_refused_event_is_not_repeated);
    RUN_TEST(test_no_counter_left);
    RUN_TEST(test_rules_are_checked);
    return UNITY_END();
}

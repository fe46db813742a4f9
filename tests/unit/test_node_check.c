/*
 * Configuration check, memory plan and start of a node.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "fake_node.h"
#include "unity.h"

static struct tsr_node_config config;
static struct fake_node fake;

void setUp(void) {}
void tearDown(void) {}

static const enum tsr_role roles[] = {TSR_ROLE_GATEWAY, TSR_ROLE_RELAY, TSR_ROLE_LEAD, TSR_ROLE_WING,
                                      TSR_ROLE_BINOCULAR};
#define ROLE_COUNT (sizeof roles / sizeof roles[0])

static void refuse(const char *expected)
{
    const char *field = NULL;
    struct tsr_memory_plan plan;
    TEST_ASSERT_EQUAL_MESSAGE(TSR_ERR_ARG, tsr_node_check(&config, &field), expected);
    TEST_ASSERT_EQUAL_STRING(expected, field);
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_node_check(&config, NULL));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_node_plan_memory(&config, &plan));
}

static void test_every_role_checks(void)
{
    for (unsigned i = 0; i < ROLE_COUNT; i++) {
        const char *field = "untouched";
        config = fake_config(roles[i]);
        TEST_ASSERT_EQUAL(TSR_OK, tsr_node_check(&config, &field));
        TEST_ASSERT_EQUAL_STRING("untouched", field);
    }
    const char *field = NULL;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_node_check(NULL, &field));
    TEST_ASSERT_EQUAL_STRING("config", field);
}

#define REFUSE(role, change, field)                                                                                    \
    do {                                                                                                               \
        config = fake_config(role);                                                                                    \
        change;                                                                                                        \
        refuse(field);                                                                                                 \
    } while (0)

static void test_network_fields(void)
{
    for (unsigned i = 0; i < ROLE_COUNT; i++) {
        REFUSE(roles[i], config.address = 0, "address");
        REFUSE(roles[i], config.address = 0xfffe, "address");
        REFUSE(roles[i], config.address = 0xffff, "address");
        REFUSE(roles[i], config.channel = 10, "channel");
        REFUSE(roles[i], config.channel = 27, "channel");
        REFUSE(roles[i], config.routes.parent = roles[i] == TSR_ROLE_GATEWAY ? FAKE_RELAY : TSR_ADDRESS_NONE,
               "routes.parent");
        REFUSE(roles[i], (config.routes.descendants = NULL, config.routes.descendant_count = 1), "routes.descendants");
    }
    REFUSE(TSR_ROLE_RELAY, config.role = (enum tsr_role)0, "role");
    REFUSE(TSR_ROLE_RELAY, config.role = (enum tsr_role)(TSR_ROLE_BINOCULAR + 1), "role");
}

/* The MAC would drop the frames of the seventeenth neighbour, for ever. */
static void test_more_neighbours_than_the_mac_keeps(void)
{
    struct tsr_route routes[TSR_MAC_NEIGHBOURS_MAX + 3];
    for (uint16_t i = 0; i < TSR_MAC_NEIGHBOURS_MAX + 3; i++) {
        routes[i].destination = routes[i].next_hop = (uint16_t)(10 + i);
    }
    config = fake_config(TSR_ROLE_GATEWAY);
    config.routes.descendants = routes;
    config.routes.descendant_count = TSR_MAC_NEIGHBOURS_MAX;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_node_check(&config, NULL));
    config.routes.descendant_count++;
    refuse("routes.descendants");
    routes[TSR_MAC_NEIGHBOURS_MAX].next_hop = 10; /* behind one that is known */
    TEST_ASSERT_EQUAL(TSR_OK, tsr_node_check(&config, NULL));
    config = fake_config(TSR_ROLE_RELAY); /* the parent is a neighbour, too */
    config.routes.descendants = routes;
    config.routes.descendant_count = TSR_MAC_NEIGHBOURS_MAX;
    refuse("routes.descendants");
    config.routes.descendant_count--;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_node_check(&config, NULL));
}

static void test_partner(void)
{
    const enum tsr_role pair[] = {TSR_ROLE_LEAD, TSR_ROLE_WING};
    for (unsigned i = 0; i < 2; i++) {
        REFUSE(pair[i], config.partner = 0, "partner");
        REFUSE(pair[i], config.partner = TSR_ADDRESS_NONE, "partner");
        REFUSE(pair[i], config.partner = TSR_ADDRESS_BROADCAST, "partner");
        REFUSE(pair[i], config.partner = config.address, "partner");
        REFUSE(pair[i], config.partner = 77, "partner"); /* by way of the parent: no common instant */
    }
    /* A partner of 0, the sink's address, would have the map sealed under the pair key. */
    REFUSE(TSR_ROLE_BINOCULAR, config.partner = 0, "partner");
    REFUSE(TSR_ROLE_RELAY, config.partner = FAKE_LEAD, "partner");
    REFUSE(TSR_ROLE_GATEWAY, config.partner = 0, "partner");
}

static void test_camera_fields(void)
{
    const enum tsr_role cameras[] = {TSR_ROLE_LEAD, TSR_ROLE_WING, TSR_ROLE_BINOCULAR};
    for (unsigned i = 0; i < 3; i++) {
        REFUSE(cameras[i], config.change.width = 40, "width");
        REFUSE(cameras[i], config.change.height = 40, "height");
        REFUSE(cameras[i], config.similarity.width = 40, "width");
        REFUSE(cameras[i], config.similarity.height = 40, "height");
        REFUSE(cameras[i], config.change.width = 0, "width");
        REFUSE(cameras[i], config.match.disparities = 17, "disparities");
        REFUSE(cameras[i], config.match.window = 4, "window");
        REFUSE(cameras[i], config.match.mode = TSR_MATCH_CENSUS, "mode"); /* a node runs the SAD modes */
        REFUSE(cameras[i], config.change.reduction = 3, "reduction");
        REFUSE(cameras[i], config.change.watched_count = 1, "watched");
        REFUSE(cameras[i], config.similarity.block_log2 = 5, "block_log2");
        REFUSE(cameras[i], config.step_log2 = 5, "step_log2");
        REFUSE(cameras[i], config.reference_step = 64, "reference_step");
        REFUSE(cameras[i], config.reference_step = 254, "reference_step");
    }
    REFUSE(TSR_ROLE_LEAD, config.watch_period_us = 0, "watch_period_us");
    REFUSE(TSR_ROLE_BINOCULAR, config.watch_period_us = 0, "watch_period_us");
    config = fake_config(TSR_ROLE_WING);
    config.watch_period_us = 0;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_node_check(&config, NULL));
    config = fake_config(TSR_ROLE_LEAD);
    config.reference_step = TSR_REFERENCE_NONE;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_node_check(&config, NULL));
}

/* No two regions overlap, all are aligned and inside; no camera, no memory. */
static void test_plan(void)
{
    for (unsigned i = 0; i < ROLE_COUNT; i++) {
        struct tsr_memory_plan plan;
        config = fake_config(roles[i]);
        TEST_ASSERT_EQUAL(TSR_OK, tsr_node_plan_memory(&config, &plan));
        TEST_ASSERT_EQUAL(i < 2, plan.total == 0);
        for (unsigned a = 0; a < TSR_REGION_COUNT; a++) {
            TEST_ASSERT_EQUAL(0, plan.offset[a] % TSR_NODE_MEMORY_ALIGN);
            TEST_ASSERT_LESS_OR_EQUAL(plan.total, plan.offset[a] + plan.len[a]);
            for (unsigned b = 0; b < a; b++) {
                TEST_ASSERT_TRUE(plan.len[a] == 0 || plan.len[b] == 0 ||
                                 plan.offset[a] >= plan.offset[b] + plan.len[b] ||
                                 plan.offset[b] >= plan.offset[a] + plan.len[a]);
            }
        }
    }
}

static void test_arena(void)
{
    for (unsigned i = 2; i < ROLE_COUNT; i++) {
        struct tsr_memory_plan plan;
        config = fake_config(roles[i]);
        TEST_ASSERT_EQUAL(TSR_OK, tsr_node_plan_memory(&config, &plan));
        uint8_t *arena = malloc(plan.total + TSR_NODE_MEMORY_ALIGN);
        const struct tsr_node_hal hal = fake_hal(&fake);
        TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_node_init(&fake.node, &config, &hal, arena, plan.total - 1, 0));
        for (unsigned off = 1; off < TSR_NODE_MEMORY_ALIGN; off++) {
            TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_node_init(&fake.node, &config, &hal, arena + off, plan.total, 0));
        }
        TEST_ASSERT_EQUAL(TSR_OK, tsr_node_init(&fake.node, &config, &hal, arena, plan.total, 0));
        free(arena);
    }
    config = fake_config(TSR_ROLE_RELAY);
    const struct tsr_node_hal hal = fake_hal(&fake);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_node_init(&fake.node, &config, &hal, NULL, 0, 0));
}

static void test_radio_that_fails(void)
{
    config = fake_config(TSR_ROLE_RELAY);
    const struct tsr_node_hal hal = fake_hal(&fake);
    fake.radio.on_configure = TSR_ERR_IO;
    TEST_ASSERT_EQUAL(TSR_ERR_IO, tsr_node_init(&fake.node, &config, &hal, NULL, 0, 0));
    fake.radio.on_configure = TSR_OK;
    config.channel = 9;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_node_init(&fake.node, &config, &hal, NULL, 0, 0));
}

static void test_names(void)
{
    for (unsigned i = 0; i < TSR_PHASE_COUNT; i++) {
        TEST_ASSERT_TRUE(strcmp(tsr_phase_name((enum tsr_node_phase)i), "unknown") != 0);
    }
    for (unsigned i = 0; i < TSR_WORK_COUNT; i++) {
        TEST_ASSERT_TRUE(strcmp(tsr_work_name((enum tsr_work_kind)i), "unknown") != 0);
    }
    TEST_ASSERT_EQUAL_STRING("binocular", tsr_role_name(TSR_ROLE_BINOCULAR));
    TEST_ASSERT_EQUAL_STRING("sending", tsr_phase_name(TSR_PHASE_SENDING));
    TEST_ASSERT_EQUAL_STRING("copy", tsr_work_name(TSR_WORK_COPY));
    TEST_ASSERT_EQUAL_STRING("unknown", tsr_role_name((enum tsr_role)6));
    TEST_ASSERT_EQUAL_STRING("unknown", tsr_phase_name(TSR_PHASE_COUNT));
    TEST_ASSERT_EQUAL_STRING("unknown", tsr_work_name(TSR_WORK_COUNT));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_role_checks);
    RUN_TEST(test_network_fields);
    RUN_TEST(test_more_neighbours_than_the_mac_keeps);
    RUN_TEST(test_partner);
    RUN_TEST(test_camera_fields);
    RUN_TEST(test_plan);
    RUN_TEST(test_arena);
    RUN_TEST(test_radio_that_fails);
    RUN_TEST(test_names);
    return UNITY_END();
}

/*
 * A lead, 160x120 and 32 disparities, on a Cortex-M4 with 128 KB of RAM.
 *
 * The board (QEMU's mps2-an386) has neither a radio nor a camera. So the nodes
 * that a lead needs around it, its wing and a gateway, run beside it and hear
 * it through a loop-back; they stand in external memory (.lab) and do not count
 * as the lead's. UART0 is the gateway's port to a real sink.
 *
 *     .bss   lead ── loop-back ──┬── wing         .lab
 *                                └── gateway ── UART0 ── sink
 *
 *   tarsier-node                        views are a test pattern
 *   tarsier-node LEFT.pgm RIGHT.pgm     views are these pictures, by semihosting
 *
 * Ends after the first map with a line of counters: 0 the sink has it, 1 it was
 * lost or not made within a minute, 2 unusable configuration or arguments.
 *
 * The keys are known to everyone and no radio is behind them.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "tsr/hal/mps2_aes.h"
#include "tsr/hal/mps2_camera.h"
#include "tsr/hal/mps2_clock.h"
#include "tsr/hal/mps2_loopback.h"
#include "tsr/hal/mps2_semihosting.h"
#include "tsr/hal/mps2_stack.h"
#include "tsr/hal/mps2_uart.h"
#include "tsr/node/node_state.h"

#define WIDTH 160
#define HEIGHT 120
#define DISPARITIES 32
#define STEP_LOG2 3 /* 1/2 px */
#define REFERENCE_STEP 35
#define D0_Q4 539 /* of the demo's pair, 33.6875 px */

#define PAN_ID 0xbeef
#define CHANNEL 15
#define GATEWAY 1
#define LEAD 3
#define WING 4
#define COUNTER_START 0
#define WATCH_PERIOD_US 100000u
#define TIME_MAX_US UINT64_C(60000000)

/* At least what tsr_node_plan_memory says (tests/budget/memory_report.py); init refuses less. */
#define LEAD_ARENA_LEN 116480u
#define WING_ARENA_LEN 42496u
#define LINE_CAP 512u

#define LAB __attribute__((section(".lab"), aligned(TSR_NODE_MEMORY_ALIGN)))

enum exit_code {
    EXIT_COMMITTED = 0,
    EXIT_LOST = 1,
    EXIT_USAGE = 2
};

/* What the product would carry. */
static struct tsr_node lead;
static _Alignas(TSR_NODE_MEMORY_ALIGN) uint8_t lead_arena[LEAD_ARENA_LEN];

/* What stands around it. */
static LAB struct tsr_node wing;
static LAB struct tsr_node gateway;
static LAB uint8_t wing_arena[WING_ARENA_LEN];
static LAB struct tsr_mps2_loopback loopback;
static LAB struct tsr_mps2_camera left_camera;
static LAB struct tsr_mps2_camera right_camera;
static LAB uint32_t random_state;
static LAB char command_line[LINE_CAP];

static const struct tsr_route kGatewayRoutes[] = {{LEAD, LEAD}, {WING, LEAD}};
static const struct tsr_route kLeadRoutes[] = {{WING, WING}};

static void on_radio(void *node, const struct tsr_radio_event *event, uint64_t now_us)
{
    tsr_node_on_radio(node, event, now_us);
}

static void on_camera(void *node, enum tsr_status status, uint64_t time_us)
{
    tsr_node_on_camera(node, false, status, time_us);
}

/* xorshift32 (Marsaglia, 2003): the board has no source of entropy. Back-off only. */
static void fill_random(void *self, uint8_t *bytes, size_t len)
{
    (void)self;
    for (size_t i = 0; i < len; i++) {
        random_state ^= random_state << 13;
        random_state ^= random_state >> 17;
        random_state ^= random_state << 5;
        bytes[i] = (uint8_t)(random_state >> 24);
    }
}

static const struct tsr_entropy_ops kEntropyOps = {fill_random};

static struct tsr_node_config config_of(enum tsr_role role, uint16_t address)
{
    struct tsr_node_config config = {0};
    config.role = role;
    config.pan_id = PAN_ID;
    config.address = address;
    config.partner = role == TSR_ROLE_LEAD ? WING : role == TSR_ROLE_WING ? LEAD : TSR_ADDRESS_NONE;
    config.channel = CHANNEL;
    config.counter_start = COUNTER_START;
    config.watch_period_us = WATCH_PERIOD_US;
    memset(config.link_key, 0xc0, sizeof config.link_key);
    memset(config.node_key, address, sizeof config.node_key);
    memset(config.pair_key, 0xc1, sizeof config.pair_key);
    config.change.width = WIDTH;
    config.change.height = HEIGHT;
    config.match.width = WIDTH;
    config.match.height = HEIGHT;
    config.match.disparities = DISPARITIES;
    config.similarity.width = WIDTH;
    config.similarity.height = HEIGHT;
    config.step_log2 = STEP_LOG2;
    config.reference_step = REFERENCE_STEP;
    config.d0_q4 = D0_Q4;
    return config;
}

static enum tsr_status start_node(struct tsr_node *node, const struct tsr_node_config *config, struct tsr_camera camera,
                                  uint8_t *arena, size_t arena_cap)
{
    struct tsr_node_hal hal = {0};
    hal.aes = &tsr_mps2_aes;
    hal.entropy.ops = &kEntropyOps;
    hal.left = camera;
    hal.port = tsr_mps2_uart_start();
    enum tsr_status status = tsr_mps2_loopback_add(&loopback, on_radio, node, &hal.radio);
    return status == TSR_OK ? tsr_node_init(node, config, &hal, arena, arena_cap, tsr_mps2_clock_now_us()) : status;
}

static enum tsr_status start_site(const char *left_file, const char *right_file)
{
    random_state = 1;
    tsr_mps2_clock_start();
    tsr_mps2_loopback_init(&loopback, tsr_mps2_clock_now_us);
    struct tsr_camera left =
        tsr_mps2_camera_init(&left_camera, left_file, false, tsr_mps2_clock_now_us, on_camera, &lead);
    struct tsr_camera right =
        tsr_mps2_camera_init(&right_camera, right_file, true, tsr_mps2_clock_now_us, on_camera, &wing);
    const struct tsr_camera none = {0};

    struct tsr_node_config config = config_of(TSR_ROLE_GATEWAY, GATEWAY);
    config.routes.parent = TSR_ADDRESS_NONE;
    config.routes.descendants = kGatewayRoutes;
    config.routes.descendant_count = sizeof kGatewayRoutes / sizeof kGatewayRoutes[0];
    enum tsr_status status = start_node(&gateway, &config, none, NULL, 0);
    if (status == TSR_OK) {
        config = config_of(TSR_ROLE_LEAD, LEAD);
        config.routes.parent = GATEWAY;
        config.routes.descendants = kLeadRoutes;
        config.routes.descendant_count = sizeof kLeadRoutes / sizeof kLeadRoutes[0];
        status = start_node(&lead, &config, left, lead_arena, sizeof lead_arena);
    }
    if (status == TSR_OK) {
        config = config_of(TSR_ROLE_WING, WING);
        config.routes.parent = LEAD;
        status = start_node(&wing, &config, right, wing_arena, sizeof wing_arena);
    }
    return status;
}

static uint64_t earlier(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static void take_port(void)
{
    uint8_t byte;
    while (tsr_mps2_uart_read(&byte)) {
        tsr_node_on_port(&gateway, &byte, 1, tsr_mps2_clock_now_us());
    }
}

/* One step of one node, and what interrupts would do before and after it. */
static uint64_t serve(struct tsr_node *node)
{
    tsr_mps2_loopback_poll(&loopback);
    tsr_mps2_camera_poll(&left_camera);
    tsr_mps2_camera_poll(&right_camera);
    take_port();
    tsr_node_on_timer(node, tsr_mps2_clock_now_us());
    uint64_t wake_us = tsr_node_step(node, tsr_mps2_clock_now_us()).wake_us;
    tsr_node_on_timer(node, tsr_mps2_clock_now_us());
    return earlier(wake_us, tsr_node_timer_us(node));
}

static bool has_ended(void)
{
    const struct tsr_node_counters *counters = tsr_node_get_counters(&lead);
    return counters->maps_sent + counters->maps_lost > 0 || tsr_mps2_clock_now_us() > TIME_MAX_US;
}

static void run(void)
{
    while (!has_ended()) {
        uint64_t wake_us = earlier(serve(&gateway), earlier(serve(&lead), serve(&wing)));
        wake_us = earlier(wake_us, tsr_mps2_loopback_timer_us(&loopback));
        wake_us = earlier(wake_us, tsr_mps2_camera_timer_us(&left_camera));
        tsr_mps2_clock_sleep_until(earlier(wake_us, tsr_mps2_camera_timer_us(&right_camera)));
    }
}

static void print_field(const char *name, size_t value)
{
    tsr_mps2_print(name);
    tsr_mps2_print_number((uint32_t)value);
}

static void print_report(void)
{
    const struct tsr_node_counters *counters = tsr_node_get_counters(&lead);
    print_field("frames_watched ", counters->frames_watched);
    print_field(" frames_woken ", counters->frames_woken);
    print_field(" captures_failed ", counters->captures_failed);
    print_field(" maps_made ", counters->maps_made);
    print_field(" maps_sent ", counters->maps_sent);
    print_field(" maps_lost ", counters->maps_lost);
    print_field(" map_bytes ", counters->map_bytes);
    print_field(" view_bytes ", tsr_node_get_counters(&wing)->view_bytes);
    print_field(" frames_on_loopback ", loopback.frames);
    print_field(" time_ms ", (size_t)((uint32_t)tsr_mps2_clock_now_us() / 1000u));
    print_field(" stack_used ", tsr_mps2_stack_used_len());
    print_field(" stack_len ", tsr_mps2_stack_len());
    print_field(" node_len ", sizeof lead);
    tsr_mps2_print("\n");
}

/* The rest of the line after its first word, which is cut off; NULL if there is none. */
static char *cut_word(char *line)
{
    char *blank = line != NULL ? strchr(line, ' ') : NULL;
    if (blank == NULL) {
        return NULL;
    }
    *blank = '\0';
    return blank + 1;
}

int main(void)
{
    if (tsr_mps2_command_line(command_line, sizeof command_line) != TSR_OK) {
        return EXIT_USAGE;
    }
    char *left_file = cut_word(command_line); /* the first word is the program's name */
    char *right_file = cut_word(left_file);
    if ((left_file == NULL) != (right_file == NULL)) {
        tsr_mps2_print("tarsier-node: give both pictures or none\n");
        return EXIT_USAGE;
    }
    enum tsr_status status = start_site(left_file, right_file);
    if (status != TSR_OK) {
        tsr_mps2_print("tarsier-node: does not start: ");
        tsr_mps2_print(tsr_status_name(status));
        tsr_mps2_print("\n");
        return EXIT_USAGE;
    }
    run();
    print_report();
    return tsr_node_get_counters(&lead)->maps_sent > 0 ? EXIT_COMMITTED : EXIT_LOST;
}

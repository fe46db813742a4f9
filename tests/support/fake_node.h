/*
 * One node alone, for tests: configurations of every role, a camera that
 * answers at once, a port that counts, and sealed frames to give it.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TEST_FAKE_NODE_H
#define TSR_TEST_FAKE_NODE_H

#include <stdlib.h>

#include "fake_radio.h"
#include "mbedtls_aes.h"
#include "tsr/node/node_state.h"

#define FAKE_PAN 0xbeefu
#define FAKE_GATEWAY 1u
#define FAKE_RELAY 2u
#define FAKE_LEAD 3u
#define FAKE_WING 4u
#define FAKE_BINOCULAR 5u
#define FAKE_WIDTH 32u
#define FAKE_HEIGHT 24u

static const struct tsr_route fake_gateway_routes[] = {{2, 2}, {3, 2}, {4, 2}, {5, 2}};
static const struct tsr_route fake_relay_routes[] = {{3, 3}, {4, 3}, {5, 5}};
static const struct tsr_route fake_lead_routes[] = {{4, 4}};

static inline uint16_t fake_address(enum tsr_role role)
{
    return (uint16_t)(role == TSR_ROLE_GATEWAY ? FAKE_GATEWAY
                      : role == TSR_ROLE_RELAY ? FAKE_RELAY
                      : role == TSR_ROLE_LEAD  ? FAKE_LEAD
                      : role == TSR_ROLE_WING  ? FAKE_WING
                                               : FAKE_BINOCULAR);
}

/* Keys: link 10, 11, ..., node 20, ..., pair 30, ... */
static inline struct tsr_node_config fake_config(enum tsr_role role)
{
    struct tsr_node_config config;
    memset(&config, 0, sizeof config);
    config.role = role;
    config.pan_id = FAKE_PAN;
    config.address = fake_address(role);
    config.partner = TSR_ADDRESS_NONE;
    config.channel = 15;
    config.routes.parent = FAKE_RELAY;
    for (unsigned i = 0; i < TSR_AES_KEY_LEN; i++) {
        config.link_key[i] = (uint8_t)(10 + i);
        config.node_key[i] = (uint8_t)(20 + i);
        config.pair_key[i] = (uint8_t)(30 + i);
    }
    config.counter_start = 100;
    config.watch_period_us = 100000;
    config.change.width = config.match.width = config.similarity.width = FAKE_WIDTH;
    config.change.height = config.match.height = config.similarity.height = FAKE_HEIGHT;
    config.change.settle_frames = 1;
    config.match.disparities = 16;
    config.match.window = 5;
    config.step_log2 = 3;
    config.reference_step = 35;
    switch (role) {
    case TSR_ROLE_GATEWAY:
        config.routes.parent = TSR_ADDRESS_NONE;
        config.routes.descendants = fake_gateway_routes;
        config.routes.descendant_count = 4;
        break;
    case TSR_ROLE_RELAY:
        config.routes.parent = FAKE_GATEWAY;
        config.routes.descendants = fake_relay_routes;
        config.routes.descendant_count = 3;
        break;
    case TSR_ROLE_LEAD:
        config.partner = FAKE_WING;
        config.routes.descendants = fake_lead_routes;
        config.routes.descendant_count = 1;
        break;
    case TSR_ROLE_WING:
        config.partner = FAKE_LEAD;
        config.routes.parent = FAKE_LEAD;
        break;
    case TSR_ROLE_BINOCULAR: break;
    }
    return config;
}

struct fake_camera {
    struct tsr_gray image;
    bool pending;
    uint64_t at_us;
    unsigned calls;
};

struct fake_node {
    struct tsr_node node;
    struct fake_radio radio;
    struct fake_entropy entropy;
    struct fake_camera left;
    struct fake_camera right;
    uint32_t random; /* of the pictures */
    unsigned writes; /* to the port */
    uint8_t port[TSR_NODE_UPLINK_MAX];
    size_t port_len;
    uint8_t *arena;
    uint64_t now_us;
    uint32_t frame_counter;   /* of injected frames */
    uint32_t message_counter; /* of injected messages */
};

static inline enum tsr_status fake_camera_capture(void *self, struct tsr_gray image, uint64_t at_us)
{
    struct fake_camera *camera = (struct fake_camera *)self;
    if (camera->pending) {
        return TSR_ERR_BUSY;
    }
    camera->pending = true;
    camera->image = image;
    camera->at_us = at_us;
    camera->calls++;
    return TSR_OK;
}

static inline enum tsr_status fake_port_write(void *self, const uint8_t *bytes, size_t len)
{
    struct fake_node *fake = (struct fake_node *)self;
    fake->writes++;
    memcpy(fake->port, bytes, len);
    fake->port_len = len;
    return TSR_OK;
}

static const struct tsr_camera_ops fake_camera_ops = {fake_camera_capture};
static const struct tsr_port_ops fake_port_ops = {fake_port_write};

static inline struct tsr_node_hal fake_hal(struct fake_node *fake)
{
    struct tsr_node_hal hal;
    hal.aes = &test_aes_ops;
    hal.radio = fake_radio_of(&fake->radio);
    hal.entropy = fake_entropy_of(&fake->entropy);
    hal.left.ops = hal.right.ops = &fake_camera_ops;
    hal.left.self = &fake->left;
    hal.right.self = &fake->right;
    hal.port.ops = &fake_port_ops;
    hal.port.self = fake;
    return hal;
}

static inline enum tsr_status fake_node_start(struct fake_node *fake, const struct tsr_node_config *config)
{
    struct tsr_memory_plan plan;
    memset(fake, 0, sizeof *fake);
    fake->entropy.step = 37;
    fake->random = 1;
    fake->now_us = 1000;
    enum tsr_status status = tsr_node_plan_memory(config, &plan);
    if (status != TSR_OK) {
        return status;
    }
    fake->arena = plan.total > 0 ? (uint8_t *)malloc(plan.total) : NULL; /* exact, for the sanitizer */
    if (plan.total > 0 && fake->arena == NULL) {
        return TSR_ERR_NOBUF; /* the machine's, not the node's */
    }
    const struct tsr_node_hal hal = fake_hal(fake);
    status = tsr_node_init(&fake->node, config, &hal, fake->arena, plan.total, fake->now_us);
    tsr_node_on_timer(&fake->node, fake->now_us);
    return status;
}

static inline void fake_node_stop(struct fake_node *fake)
{
    free(fake->arena);
    fake->arena = NULL;
}

/* Step at the present instant until there is no work left; at most so many steps. */
static inline unsigned fake_node_run(struct fake_node *fake, unsigned steps_max)
{
    unsigned steps = 0;
    while (steps < steps_max) {
        steps++;
        const struct tsr_node_outcome outcome = tsr_node_step(&fake->node, fake->now_us);
        tsr_node_on_timer(&fake->node, fake->now_us);
        if (outcome.work == TSR_WORK_NONE) {
            break;
        }
    }
    return steps;
}

/* End a capture under way with a noise picture, or with an error. */
static inline void fake_camera_finish(struct fake_node *fake, bool right, enum tsr_status status)
{
    struct fake_camera *camera = right ? &fake->right : &fake->left;
    if (!camera->pending) {
        return;
    }
    for (unsigned y = 0; y < camera->image.height; y++) {
        for (unsigned x = 0; x < camera->image.width; x++) {
            fake->random = fake->random * 1664525u + 1013904223u;
            camera->image.pixels[y * camera->image.stride + x] = (uint8_t)(fake->random >> 24);
        }
    }
    camera->pending = false;
    tsr_node_on_camera(&fake->node, right, status, camera->at_us > fake->now_us ? camera->at_us : fake->now_us);
}

/* End the transmission under way, if there is one. */
static inline void fake_node_transmitted(struct fake_node *fake, enum tsr_radio_outcome outcome)
{
    if (fake->radio.busy) {
        const struct tsr_radio_event event = fake_radio_done(&fake->radio, outcome, fake->now_us);
        tsr_node_on_radio(&fake->node, &event, fake->now_us);
        tsr_node_on_timer(&fake->node, fake->now_us);
    }
}

/* A frame with this payload arrives, rightly sealed by a neighbour. */
static inline void fake_node_hear(struct fake_node *fake, uint16_t neighbour, const uint8_t *payload, size_t len)
{
    const struct tsr_cipher link = test_cipher(10);
    const struct tsr_frame_header header = {(uint8_t)fake->frame_counter, true,      FAKE_PAN,
                                            fake->node.config.address,    neighbour, ++fake->frame_counter};
    uint8_t psdu[TSR_FRAME_PSDU_MAX];
    size_t psdu_len = 0;
    if (tsr_frame_seal(&header, &link, payload, len, psdu, sizeof psdu, &psdu_len) == TSR_OK) {
        const struct tsr_radio_event event = fake_radio_heard(psdu, psdu_len, fake->now_us);
        tsr_node_on_radio(&fake->node, &event, fake->now_us);
        tsr_node_on_timer(&fake->node, fake->now_us);
    }
}

struct fake_message {
    uint8_t kind;
    uint8_t key_use;
    uint16_t origin;
    uint16_t destination;
    const uint8_t *body;
    size_t body_len;
};

/* Seal a message under its right key; gives its length in message. */
static inline size_t fake_node_seal(struct fake_node *fake, const struct fake_message *message, uint8_t *bytes,
                                    size_t cap, uint32_t *counter)
{
    const struct tsr_cipher cipher = test_cipher(message->key_use == TSR_KEY_PAIR ? 30 : 20);
    const struct tsr_message_header header = {message->kind, message->key_use, message->origin, message->destination,
                                              ++fake->message_counter};
    size_t len = 0;
    if (message->body_len > 0) {
        memcpy(bytes + TSR_MESSAGE_HEADER_LEN, message->body, message->body_len);
    }
    (void)tsr_message_seal(&header, &cipher, bytes, cap, message->body_len, &len);
    *counter = header.counter;
    return len;
}

/* One fragment of a sealed message arrives from a neighbour. */
static inline void fake_node_hear_piece(struct fake_node *fake, uint16_t neighbour, const struct fake_message *message,
                                        const uint8_t *bytes, size_t len, uint32_t counter, uint16_t index, bool poll)
{
    struct tsr_fragment fragment = tsr_fragment_of(bytes, len, index);
    uint8_t payload[TSR_FRAME_PAYLOAD_MAX];
    size_t payload_len = 0;
    fragment.origin = message->origin;
    fragment.destination = message->destination;
    fragment.message_id = (uint16_t)counter;
    fragment.poll = poll;
    if (tsr_fragment_write(&fragment, payload, sizeof payload, &payload_len) == TSR_OK) {
        fake_node_hear(fake, neighbour, payload, payload_len);
    }
}

/* A short message arrives. */
static inline void fake_node_hear_message(struct fake_node *fake, uint16_t neighbour,
                                          const struct fake_message *message)
{
    uint8_t bytes[TSR_FRAGMENT_PIECE_MAX];
    uint32_t counter = 0;
    const size_t len = fake_node_seal(fake, message, bytes, sizeof bytes, &counter);
    fake_node_hear_piece(fake, neighbour, message, bytes, len, counter, 0, false);
}

/* An answer to one of the node's messages, from its partner or, under the node's key, the sink. */
static inline void fake_node_hear_status(struct fake_node *fake, uint8_t key_use, uint16_t origin, uint16_t message_id,
                                         enum tsr_delivery state)
{
    uint8_t body[TSR_BODY_STATUS_MAX];
    size_t len = 0;
    struct tsr_body_status status;
    memset(&status, 0, sizeof status);
    status.message_id = message_id;
    status.state = (uint8_t)state;
    (void)tsr_body_write_status(&status, body, sizeof body, &len);
    const struct fake_message message = {TSR_MESSAGE_STATUS, key_use, origin, fake->node.config.address, body, len};
    fake_node_hear_message(fake, key_use == TSR_KEY_PAIR ? origin : FAKE_RELAY, &message);
}

#endif

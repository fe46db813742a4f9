/*
 * What the files of the node share. Not a public header.
 *
 *   memory.c   configuration check, memory plan
 *   node.c     life cycle, step, events
 *   inbox.c    messages for this node      outbox.c   messages from this node
 *   forward.c  fragments for others        uplink.c   gateway's side of the link
 *   watch.c    watching, waking, capturing wing.c     the wing's part
 *   mapping.c  from two views to a decision   report.c   coding and sending the map
 *   event.c    depth rules and their messages
 *
 * A stage function does one bounded piece of its phase and says what it did.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_NODE_INTERNAL_H
#define TSR_NODE_INTERNAL_H

#include "tsr/node/node_state.h"

/* Marks of frames among the MAC's confirms. */
enum token {
    TOKEN_NONE,
    TOKEN_SENDER,
    TOKEN_NOTICE,
    TOKEN_WAKE
};

#define ROWS_PER_STEP_DEFAULT 4u
#define SEAL_BYTES_PER_STEP 256u

struct work {
    enum tsr_work_kind kind;
    uint32_t units;
};

static inline struct work no_work(void)
{
    struct work work = {TSR_WORK_NONE, 0};
    return work;
}

static inline struct work work_of(enum tsr_work_kind kind, size_t units)
{
    struct work work = {kind, (uint32_t)units};
    return work;
}

/* Rows of the next quantum when left rows remain. */
static inline uint16_t rows_of_step(const struct tsr_node *node, unsigned left)
{
    unsigned rows = node->config.rows_per_step > 0 ? node->config.rows_per_step : ROWS_PER_STEP_DEFAULT;
    return (uint16_t)(rows < left ? rows : left);
}

static inline void enter(struct tsr_node *node, enum tsr_node_phase phase)
{
    node->phase = phase;
    node->row = 0;
    node->sealed = 0;
}

bool tsr_node_is_camera(enum tsr_role role);
bool tsr_node_watches(enum tsr_role role);

/* inbox.c: a fragment addressed to this node. */
void tsr_node_take_fragment(struct tsr_node *node, const struct tsr_fragment *fragment, uint64_t frame_time_us,
                            uint64_t now_us);
void tsr_node_reset_inbox(struct tsr_node *node);

/* outbox.c */
enum tsr_status tsr_node_send_short(struct tsr_node *node, enum tsr_message_kind kind, uint16_t destination,
                                    const uint8_t *body, size_t body_len, enum token token);
void tsr_node_answer(struct tsr_node *node, uint16_t message_id, enum tsr_delivery state);
/* Seal the body_len bytes that stand at message + TSR_MESSAGE_HEADER_LEN, all at once. */
enum tsr_status tsr_node_seal_short(struct tsr_node *node, enum tsr_message_kind kind, uint16_t destination,
                                    uint8_t message[TSR_FRAGMENT_PIECE_MAX], size_t body_len, size_t *message_len,
                                    uint32_t *counter);
/* Begin to seal the body_len bytes that stand in the message region. */
enum tsr_status tsr_node_start_sealing(struct tsr_node *node, enum tsr_message_kind kind, uint16_t destination);
/* *done when the sender has taken the sealed message over. */
struct work tsr_node_continue_sealing(struct tsr_node *node, uint16_t destination, uint64_t now_us, bool *done);

/* forward.c: take one received frame; false if there is none or no room to forward it. */
bool tsr_node_take_frame(struct tsr_node *node, uint64_t now_us);
enum tsr_status tsr_node_forward(struct tsr_node *node, const struct tsr_fragment *fragment);

/* uplink.c */
void tsr_node_start_uplink(struct tsr_node *node, uint64_t now_us);
bool tsr_node_uplink_free(const struct tsr_node *node);
void tsr_node_send_uplink(struct tsr_node *node, const uint8_t *fragment, size_t len, uint64_t time_us,
                          uint64_t now_us);
void tsr_node_repeat_uplink(struct tsr_node *node, uint64_t now_us);

/* watch.c */
struct work tsr_node_watch(struct tsr_node *node, uint64_t now_us);
void tsr_node_on_wake_confirm(struct tsr_node *node, const struct tsr_mac_confirm *confirm, uint64_t now_us);
void tsr_node_abandon_capture(struct tsr_node *node, uint64_t now_us);
/* Back to watching, at the next beat of the watch period. */
void tsr_node_rest(struct tsr_node *node, uint64_t now_us);
enum tsr_status tsr_node_start_capture(struct tsr_node *node, bool right, uint64_t at_us);
struct tsr_gray tsr_node_left_view(struct tsr_node *node);

/* wing.c */
struct work tsr_node_serve_lead(struct tsr_node *node, uint64_t now_us);
void tsr_node_on_wake(struct tsr_node *node, const struct tsr_body_capture *wake, uint64_t frame_time_us);

/* mapping.c: UNPACKING .. COMPARING */
struct work tsr_node_make_map(struct tsr_node *node, uint64_t now_us);

/* event.c: MEASURING, or past it if there is nothing to measure now */
void tsr_node_start_measuring(struct tsr_node *node, uint64_t now_us);
struct work tsr_node_measure(struct tsr_node *node, uint64_t now_us);
/* When its sender is done. */
void tsr_node_finish_notice(struct tsr_node *node);
/* NULL, or the name of a bad field. */
const char *tsr_node_check_rules(const struct tsr_node_config *config);

/* report.c: ENCODING .. SENDING */
struct work tsr_node_report_map(struct tsr_node *node, uint64_t now_us);
/* The map that was under way while the node watched is committed or lost. */
void tsr_node_finish_map(struct tsr_node *node);

#endif

/*
 * The content of a node, public only so that its size is known where one is
 * placed in static memory. Private to firmware/node.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_NODE_NODE_STATE_H
#define TSR_NODE_NODE_STATE_H

#include "tsr/codec/map.h"
#include "tsr/codec/picture.h"
#include "tsr/codec/view.h"
#include "tsr/node/node.h"
#include "tsr/vision/median.h"
#include "tsr/vision/prefilter.h"
#include "tsr/wire/body.h"
#include "tsr/wire/link.h"
#include "tsr/wire/message.h"

/* An UPLINK or HELLO, stuffed. */
#define TSR_NODE_UPLINK_MAX (2u * (TSR_LINK_HEADER_LEN + TSR_LINK_UPLINK_HEADER_LEN + TSR_FRAME_PAYLOAD_MAX + 2u) + 2u)

/* Gateway's side of the link: one frame unanswered at a time. */
struct tsr_uplink {
    struct tsr_link_decoder decoder;
    uint64_t timer_us; /* repeat the frame then */
    uint16_t sequence;
    bool waiting;
    uint16_t frame_len;
    uint8_t frame[TSR_NODE_UPLINK_MAX];
};

/* One camera's capture; the flags cross from interrupt to task. */
struct tsr_capture {
    uint64_t time_us;
    enum tsr_status status;
    bool pending;
    bool done; /* by __atomic built-ins */
};

/* Depth rules: what the sink knows, and the EVENT message that tells it more. */
struct tsr_notice {
    uint16_t reported[TSR_DEPTH_RULES_MAX]; /* see event.c */
    uint16_t found[TSR_DEPTH_RULES_MAX];
    uint8_t rule; /* being measured */
    bool under_way;
    struct tsr_sender sender;
    struct tsr_body_events body;
    uint8_t message[TSR_FRAGMENT_PIECE_MAX];
};

struct tsr_node {
    struct tsr_node_config config;
    struct tsr_node_hal hal;
    struct tsr_node_counters counters;
    struct tsr_mac mac;
    struct tsr_sender sender;
    struct tsr_cipher link_cipher;
    struct tsr_cipher node_cipher;
    struct tsr_cipher pair_cipher;
    uint32_t message_counter; /* last used */
    uint32_t sealing_counter; /* of the message in the message region */
    uint32_t sink_counter;    /* last accepted from the sink */
    uint32_t partner_counter; /* last accepted from the partner */
    bool sink_heard;
    bool partner_heard;

    enum tsr_node_phase phase;
    uint64_t phase_timer_us; /* next watch, or end of patience */
    uint64_t next_watch_us;
    uint64_t next_measure_us; /* TSR_TIME_NEVER: only when the picture changes */
    bool recapture;           /* what has changed did not reach the sink */
    bool has_last_map;
    bool map_under_way; /* and watching meanwhile */
    bool measures_only; /* this capture: nothing has changed, or the message region is not free for its map */
    uint16_t capture_id;
    uint8_t attempt;
    bool wake_due; /* lead: a WAKE is to be sent; wing: one waits for the camera */
    uint64_t capture_at_us;
    uint64_t capture_time_us; /* start of exposure of the left view */
    struct tsr_capture left;
    struct tsr_capture right;

    /* Regions of the arena. */
    uint8_t *pair;
    uint8_t *message;
    size_t message_cap;
    size_t body_len;
    size_t message_len;
    size_t reference_len;
    uint16_t *last_map;
    struct tsr_view_held held; /* lead, wing: the last view exchanged; on a wing, and accepted or under way */
    uint8_t *scratch;
    size_t scratch_cap;

    struct tsr_change change;
    uint16_t disparities; /* the matcher's D, its default resolved */
    struct tsr_notice notice;
    struct tsr_reassembly inbox;
    bool inbox_ready; /* complete, being opened or used */
    bool inbox_done;  /* inbox_done_id was accepted */
    uint16_t inbox_done_id;

    /* The resumable work under way: one at a time. */
    uint16_t row;
    size_t sealed; /* bytes already through the cipher */
    struct tsr_ccm ccm;
    union {
        struct tsr_prefilter prefilter;
        struct tsr_view_change view_change;
        struct tsr_match match;
        struct tsr_median median;
        struct tsr_similarity similarity;
    } work;

    struct tsr_uplink uplink;
};

#endif

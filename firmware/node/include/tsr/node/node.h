/*
 * The node: one state machine for every role, driven by events and by time.
 *
 *   gateway    root of the tree: hands fragments to the sink and back
 *   relay      hands fragments up and down
 *   lead       watches; on a change wakes its wing, captures with it, receives
 *              its view, matches, and sends the map
 *   wing       sleeps until its lead wakes it, captures, sends its view
 *   binocular  a lead with both sensors on its own board
 *
 *   WATCHING ──change──► WAKING ─► CAPTURING ─► RECEIVING ─► UNPACKING ─┐  lead only
 *      ▲ ▲                             │ binocular                     │
 *      │ │                             └──────────► REFERENCE ◄────────┘
 *      │ │                                              │
 *      │ └── similar ── COMPARING ◄─ MEASURING ◄─ MEDIAN ◄─ MATCHING ◄
 *      │                    │ different
 *      └── committed ── SENDING ◄─ SEALING ◄─ ENCODING
 *
 * MEASURING is for depth rules; its EVENT message goes out at once, by a sender
 * of its own. A binocular node with depth rules goes on watching while its map
 * is on its way: who passes meanwhile makes an event, and the next map waits.
 *
 * Time is a parameter: nothing here reads a clock, sleeps or blocks. A step
 * does one bounded piece of work and says how much, so that a map never keeps
 * the radio waiting and an emulator can charge time and energy for it.
 *
 * Task context: tsr_node_step, tsr_node_on_port. Interrupt context:
 * tsr_node_on_radio, tsr_node_on_timer, tsr_node_on_camera. After an interrupt
 * call tsr_node_step soon; after a step call tsr_node_on_timer.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_NODE_NODE_H
#define TSR_NODE_NODE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "tsr/base/aes.h"
#include "tsr/hal/camera.h"
#include "tsr/hal/entropy.h"
#include "tsr/hal/port.h"
#include "tsr/hal/radio.h"
#include "tsr/net/mac.h"
#include "tsr/net/route.h"
#include "tsr/net/sender.h"
#include "tsr/node/depth_rule.h"
#include "tsr/vision/change.h"
#include "tsr/vision/match.h"
#include "tsr/vision/similarity.h"

enum tsr_role {
    TSR_ROLE_GATEWAY = 1,
    TSR_ROLE_RELAY,
    TSR_ROLE_LEAD,
    TSR_ROLE_WING,
    TSR_ROLE_BINOCULAR
};

enum tsr_node_phase {
    TSR_PHASE_IDLE,      /* nothing to do but forward; a watching node waits for its next frame */
    TSR_PHASE_WATCHING,  /* a frame is being captured or compared with the background */
    TSR_PHASE_WAKING,    /* WAKE is on its way to the wing */
    TSR_PHASE_CAPTURING, /* both views */
    TSR_PHASE_RECEIVING, /* the wing's view */
    TSR_PHASE_UNPACKING, /* opening and decoding it */
    TSR_PHASE_REFERENCE, /* coding the reference image */
    TSR_PHASE_MATCHING,
    TSR_PHASE_MEDIAN,
    TSR_PHASE_MEASURING, /* the zones of the depth rules */
    TSR_PHASE_COMPARING, /* with the last map the sink has; a wing: with the last view the lead has */
    TSR_PHASE_FILTERING, /* a wing: prefiltering its view */
    TSR_PHASE_ENCODING,  /* map, or view on a wing */
    TSR_PHASE_SEALING,
    TSR_PHASE_SENDING,
    TSR_PHASE_COUNT
};

/* What a step did, for the table of measured instruction counts. */
enum tsr_work_kind {
    TSR_WORK_NONE,
    TSR_WORK_CHANGE,           /* units: pixels of the full frame */
    TSR_WORK_MATCH,            /* rows of matcher work x width x disparities */
    TSR_WORK_MEDIAN,           /* pixels */
    TSR_WORK_MEASURE,          /* pixels of zones, at each visit */
    TSR_WORK_COMPARE,          /* pixels, quantised and compared */
    TSR_WORK_MAP_ENCODE,       /* pixels */
    TSR_WORK_VIEW_FILTER,      /* pixels, once for prefiltering and once for comparing with the held view */
    TSR_WORK_VIEW_ENCODE,      /* pixels */
    TSR_WORK_REFERENCE_ENCODE, /* pixels */
    TSR_WORK_VIEW_DECODE,      /* pixels */
    TSR_WORK_SEAL,             /* bytes sealed or opened, messages and frames */
    TSR_WORK_COPY,             /* bytes */
    TSR_WORK_COUNT
};

struct tsr_node_config {
    enum tsr_role role;
    uint16_t pan_id;
    uint16_t address;
    uint16_t partner; /* lead: its wing, wing: its lead, one hop away; otherwise TSR_ADDRESS_NONE */
    uint8_t channel;
    struct tsr_routes routes;
    uint8_t link_key[TSR_AES_KEY_LEN]; /* every node of the site */
    uint8_t node_key[TSR_AES_KEY_LEN]; /* this node and the sink; unused by gateway and relay */
    uint8_t pair_key[TSR_AES_KEY_LEN]; /* lead and wing */
    /* Above every frame and message counter this node has used under these
     * keys: a counter used twice breaks the seal. */
    uint32_t counter_start;

    /* Camera roles; width and height of all three agree. */
    uint32_t watch_period_us;
    struct tsr_change_config change;
    struct tsr_match_config match; /* of a SAD mode; lead and wing of a pair have the same */
    struct tsr_similarity_config similarity;
    const struct tsr_depth_rule *rules; /* [rule_count] kept */
    uint8_t rule_count;                 /* 0 .. TSR_DEPTH_RULES_MAX */
    uint32_t measure_period_us; /* their zones are measured so often at least; 0: only when the picture changes */
    int16_t d0_q4;              /* disparity offset of the pair, px, Q12.4; carried in the map */
    uint8_t step_log2;          /* map's step 2^k / 16 px, 0..4 */
    /* Quantiser of the reference image, 0..63 (tsr/codec/picture.h): 2^(k/8) gray
     * levels in flat parts, 35 for an SSIM of 0.9; TSR_REFERENCE_NONE sends none. */
    uint8_t reference_step;
    /* Work quantum of image stages, rows; 0 means 4. The reference image takes whole bands of 8. */
    uint8_t rows_per_step;
};

#define TSR_REFERENCE_NONE UINT8_C(255)

struct tsr_node_hal { /* instances are kept */
    const struct tsr_aes_ops *aes;
    struct tsr_radio radio;
    struct tsr_entropy entropy;
    struct tsr_camera left;  /* lead, wing (its only one), binocular */
    struct tsr_camera right; /* binocular */
    struct tsr_port port;    /* gateway */
};

/* Every frame watched, view, map and fragment ends in exactly one of these. */
struct tsr_node_counters {
    uint32_t frames_watched;
    uint32_t frames_woken;    /* of these: began a capture of the pair */
    uint32_t captures_failed; /* camera error, wing not reached, view not received */
    uint32_t wakes_sent;      /* WAKE frames, repetitions included */
    uint32_t views_sent;      /* wing: accepted by the lead */
    uint32_t views_lost;      /* wing: given up or refused; the next one is sent on its own */
    uint32_t view_bytes;      /* wing: sealed, sent once */
    uint32_t maps_made;
    uint32_t maps_withheld;      /* similar to the last one the sink has */
    uint32_t maps_measured;      /* for the depth rules alone: another one was under way, or nothing had changed */
    uint32_t maps_sent;          /* committed by the sink */
    uint32_t maps_lost;          /* given up or refused */
    uint32_t map_bytes;          /* sealed, sent once, with reference image */
    uint32_t events_sent;        /* of depth rules, committed by the sink */
    uint32_t events_lost;        /* given up, and to be judged again, or refused */
    uint32_t references_omitted; /* would not fit beside the map */
    uint32_t forwarded;          /* fragments handed on */
    uint32_t dropped_route;      /* no next hop, or out of hops */
    uint32_t dropped_format;     /* fragments that do not follow their format */
    uint32_t dropped_foreign;    /* for this node, but nothing it expects */
    uint32_t dropped_auth;       /* messages whose tag does not verify */
    uint32_t dropped_replay;
    uint32_t dropped_queue; /* fragments from the sink and answers to the wing that found no room in the MAC */
    uint32_t uplinks;       /* gateway: fragments given to the sink */
    uint32_t uplink_repeats;
    uint32_t downlinks;
    uint32_t port_rejected; /* gateway: link frames that do not follow their format */
};

struct tsr_node_outcome {
    uint64_t wake_us; /* step again at this time or at the next event; now_us if work is left */
    enum tsr_work_kind work;
    uint32_t units;
};

/* Where a node's memory goes: see docs/memory.md. Offsets from the arena's
 * start; regions with the same offset overlay each other in time. */
enum tsr_region {
    TSR_REGION_PAIR,      /* both frames, then the map over them; the wing's one frame */
    TSR_REGION_MESSAGE,   /* the message under way, in or out */
    TSR_REGION_LAST_MAP,  /* the last map the sink has committed */
    TSR_REGION_CHANGE,    /* background model */
    TSR_REGION_HELD_VIEW, /* the last view that lead and wing both hold, packed */
    TSR_REGION_SCRATCH,   /* matcher, median, coders: one at a time */
    TSR_REGION_COUNT
};

struct tsr_memory_plan {
    size_t offset[TSR_REGION_COUNT];
    size_t len[TSR_REGION_COUNT]; /* 0: the role has no such region */
    size_t total;                 /* bytes of arena */
};

#define TSR_NODE_MEMORY_ALIGN 8

/* TSR_OK, or TSR_ERR_ARG with *field (may be null) naming the first bad field. */
enum tsr_status tsr_node_check(const struct tsr_node_config *config, const char **field);

/* The arena a configuration needs. TSR_ERR_ARG if it does not check. */
enum tsr_status tsr_node_plan_memory(const struct tsr_node_config *config, struct tsr_memory_plan *plan);

struct tsr_node; /* tsr/node/node_state.h, for whoever places one in memory */

/*
 * Begin life: receive, and watch if the role does.
 *
 *   config, hal  borrowed (copied); what they point to is kept
 *   arena        [arena_cap] kept, aligned to TSR_NODE_MEMORY_ALIGN
 *
 * TSR_ERR_ARG: bad field or misaligned arena; TSR_ERR_NOBUF: arena_cap; what
 * radio or cipher return. On error the node must not be used.
 */
enum tsr_status tsr_node_init(struct tsr_node *node, const struct tsr_node_config *config,
                              const struct tsr_node_hal *hal, uint8_t *arena, size_t arena_cap, uint64_t now_us);

struct tsr_node_outcome tsr_node_step(struct tsr_node *node, uint64_t now_us);

/* Bytes from the sink, any number of them. */
void tsr_node_on_port(struct tsr_node *node, const uint8_t *bytes, size_t len, uint64_t now_us);

void tsr_node_on_radio(struct tsr_node *node, const struct tsr_radio_event *event, uint64_t now_us);
void tsr_node_on_timer(struct tsr_node *node, uint64_t now_us);
/* When tsr_node_on_timer wants to be called; TSR_TIME_NEVER if not. */
uint64_t tsr_node_timer_us(const struct tsr_node *node);

/* A capture of the left or right camera is done; its buffer is the node's
 * again. time_us: start of exposure. */
void tsr_node_on_camera(struct tsr_node *node, bool right, enum tsr_status status, uint64_t time_us);

enum tsr_node_phase tsr_node_get_phase(const struct tsr_node *node);
/* Nothing is under way: no frame queued, no message being sent, nothing the
 * sink has to answer. */
bool tsr_node_is_quiet(const struct tsr_node *node);
const struct tsr_node_counters *tsr_node_get_counters(const struct tsr_node *node);
const struct tsr_mac_counters *tsr_node_get_mac_counters(const struct tsr_node *node);
const struct tsr_sender_counters *tsr_node_get_sender_counters(const struct tsr_node *node);

const char *tsr_role_name(enum tsr_role role);
const char *tsr_phase_name(enum tsr_node_phase phase);
const char *tsr_work_name(enum tsr_work_kind kind);

#endif

/*
 * Bodies of the messages: what stands inside the seal.
 *
 *   WAKE    capture id u16 | attempt u8
 *   VIEW    capture id u16 | attempt u8 | coded gray image
 *   MAP     capture time u64 (us) | capture id u16 | reference length u32 |
 *           coded reference image (may be empty) | coded disparity map
 *   EVENT   capture time u64 (us) | capture id u16 | 1 .. 8 times:
 *           rule u8 | kind u8 | share u16 (UQ4.12) | disparity u16 (UQ8.8)
 *   STATUS  message id u16 it answers | state u8 |
 *           first u16 | bitmap (bit i of byte j: fragment first + 8 j + i is missing)
 *
 * Reading never looks outside the given bytes; what points into them is
 * borrowed. TSR_ERR_FORMAT for bytes that do not follow.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_WIRE_BODY_H
#define TSR_WIRE_BODY_H

#include <stddef.h>
#include <stdint.h>

#include "tsr/base/status.h"
#include "tsr/wire/fragment.h"
#include "tsr/wire/message.h"

#define TSR_BODY_WAKE_LEN 3u
#define TSR_BODY_VIEW_HEADER_LEN 3u
#define TSR_BODY_MAP_HEADER_LEN 14u
#define TSR_BODY_EVENT_HEADER_LEN 10u
#define TSR_BODY_EVENT_LEN 6u  /* each */
#define TSR_BODY_EVENTS_MAX 8u /* so that an EVENT message is one fragment */
#define TSR_BODY_STATUS_HEADER_LEN 5u
/* A STATUS message is one fragment. */
#define TSR_BODY_STATUS_BITMAP_MAX (TSR_FRAGMENT_PIECE_MAX - TSR_MESSAGE_OVERHEAD_LEN - TSR_BODY_STATUS_HEADER_LEN)
#define TSR_BODY_STATUS_MAX (TSR_BODY_STATUS_HEADER_LEN + TSR_BODY_STATUS_BITMAP_MAX)

/* The capture that a WAKE asks for and a VIEW answers. Both boards capture
 * TSR_CAPTURE_DELAY_US after the end of the WAKE frame that was acknowledged.
 * If only the acknowledgement was lost, the wing must hear a further WAKE before
 * its camera has begun. One more attempt takes 864 us to miss the acknowledgement,
 * at most 2240 us of back-off, 320 us to sense and turn around and 1920 us of
 * frame: three such fit, or one on a busy channel. */
#define TSR_CAPTURE_DELAY_US 20000u
/* How long before the instant a board orders its camera, and the largest
 * lateness at which a capture is still of that instant. */
#define TSR_CAPTURE_ORDER_US 1000u

struct tsr_body_capture {
    uint16_t capture_id;
    uint8_t attempt; /* of the WAKE; only the last one's capture counts */
};

struct tsr_body_map {
    uint64_t capture_time_us; /* the node's clock */
    uint16_t capture_id;
    const uint8_t *reference; /* coded gray image, NULL if reference_len is 0 */
    size_t reference_len;
    const uint8_t *map; /* coded disparity map */
    size_t map_len;
};

enum tsr_event_kind {
    TSR_EVENT_BEGUN = 1,    /* a zone has come nearer, or farther, than its rule's limit */
    TSR_EVENT_ENDED = 2,    /* and is so no more */
    TSR_EVENT_MEASURED = 3, /* a surface is at this disparity now */
    TSR_EVENT_VANISHED = 4  /* there is no surface any more */
};

#define TSR_EVENT_SHARE_ONE 4096u
#define TSR_EVENT_NO_DISPARITY UINT16_C(0xffff)

struct tsr_body_event {    /* of one depth rule */
    uint8_t rule;          /* which, counted from 0 in the order of the pair's rules */
    uint8_t kind;          /* enum tsr_event_kind */
    uint16_t share_q12;    /* part of the zone's pixels that count, 0 .. TSR_EVENT_SHARE_ONE */
    uint16_t disparity_q8; /* their mean, px, UQ8.8, without d0; TSR_EVENT_NO_DISPARITY: none counts */
};

struct tsr_body_events {
    uint64_t capture_time_us; /* the node's clock */
    uint16_t capture_id;
    uint8_t count; /* 1 .. TSR_BODY_EVENTS_MAX */
    struct tsr_body_event events[TSR_BODY_EVENTS_MAX];
};

enum tsr_delivery {
    TSR_DELIVERY_MISSING = 1,   /* the bitmap names what has to come again */
    TSR_DELIVERY_COMMITTED = 2, /* on disk (sink) or in use (lead) */
    TSR_DELIVERY_REFUSED = 3    /* complete but not acceptable; sending it again is no use */
};

struct tsr_body_status {
    uint16_t message_id;
    uint8_t state;  /* enum tsr_delivery */
    uint16_t first; /* fragment of the bitmap's first bit, a multiple of 8 */
    uint8_t bitmap_len;
    uint8_t bitmap[TSR_BODY_STATUS_BITMAP_MAX];
};

void tsr_body_write_capture(const struct tsr_body_capture *body, uint8_t bytes[TSR_BODY_WAKE_LEN]);
/* Reads the three bytes in front of a WAKE or VIEW; what follows is not looked at. */
enum tsr_status tsr_body_read_capture(const uint8_t *bytes, size_t len, struct tsr_body_capture *body);

void tsr_body_write_map_header(uint64_t capture_time_us, uint16_t capture_id, size_t reference_len,
                               uint8_t bytes[TSR_BODY_MAP_HEADER_LEN]);
enum tsr_status tsr_body_read_map(const uint8_t *bytes, size_t len, struct tsr_body_map *body);

/* TSR_ERR_ARG: count; TSR_ERR_NOBUF: cap. */
enum tsr_status tsr_body_write_events(const struct tsr_body_events *body, uint8_t *bytes, size_t cap, size_t *len);
enum tsr_status tsr_body_read_events(const uint8_t *bytes, size_t len, struct tsr_body_events *body);

enum tsr_status tsr_body_write_status(const struct tsr_body_status *body, uint8_t *bytes, size_t cap, size_t *len);
enum tsr_status tsr_body_read_status(const uint8_t *bytes, size_t len, struct tsr_body_status *body);

/* The answer to a poll for a reassembly: MISSING with the first gap's bitmap,
 * or the given state if nothing is missing. */
struct tsr_body_status tsr_body_status_of(const struct tsr_reassembly *reassembly, enum tsr_delivery complete_state);

#endif

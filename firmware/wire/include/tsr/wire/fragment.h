/*
 * Fragments: a message cut into frame payloads, and put together again.
 *
 *   octets     1      1     2       2          2        2      2     0..90
 *           dispatch ttl  origin destination message  index  count  piece
 *                                            id
 *   dispatch  0 0 0 1 0 0 0 P   P = poll: the receiver answers with a STATUS
 *
 * The two high bits of the dispatch are 00, "not a LoWPAN frame" (RFC 4944,
 * 5.1), so that protocol analysers show plain data. The message id is the low
 * half of the message's counter. Every piece but the last is full, so index
 * and count give the place of each byte.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_WIRE_FRAGMENT_H
#define TSR_WIRE_FRAGMENT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "tsr/base/status.h"
#include "tsr/wire/frame.h"

#define TSR_FRAGMENT_HEADER_LEN 12u
#define TSR_FRAGMENT_PIECE_MAX (TSR_FRAME_PAYLOAD_MAX - TSR_FRAGMENT_HEADER_LEN)
#define TSR_FRAGMENT_COUNT_MAX 1024u /* 92,160 bytes; bounds every bitmap */
#define TSR_FRAGMENT_TTL_START 16u   /* hops; a loop in a faulty tree ends */

struct tsr_fragment {
    bool poll;
    uint8_t ttl;
    uint16_t origin;
    uint16_t destination;
    uint16_t message_id;
    uint16_t index;       /* 0 .. count - 1 */
    uint16_t count;       /* 1 .. TSR_FRAGMENT_COUNT_MAX */
    const uint8_t *piece; /* borrowed */
    uint8_t piece_len;
};

/* Fragments of a message of message_len bytes; 0 for an empty or too long one. */
uint16_t tsr_fragment_count(size_t message_len);

/* Fragment index of a message; piece points into it. index < tsr_fragment_count(message_len). */
struct tsr_fragment tsr_fragment_of(const uint8_t *message, size_t message_len, uint16_t index);

/* Write a fragment. TSR_ERR_NOBUF, or TSR_ERR_ARG if a field is out of its range. */
enum tsr_status tsr_fragment_write(const struct tsr_fragment *fragment, uint8_t *bytes, size_t cap, size_t *len);

/* Read a fragment; its piece points into bytes. TSR_ERR_VERSION: another
 * dispatch; TSR_ERR_FORMAT: fields or length that cannot be. */
enum tsr_status tsr_fragment_read(const uint8_t *bytes, size_t len, struct tsr_fragment *fragment);

/* One message being put together, in a caller's buffer. */
struct tsr_reassembly {
    uint8_t *message; /* kept */
    size_t message_cap;
    size_t message_len; /* 0 until the last fragment came */
    uint16_t origin;
    uint16_t destination;
    uint16_t message_id;
    uint16_t count; /* 0 = idle */
    uint16_t received;
    uint8_t have[TSR_FRAGMENT_COUNT_MAX / 8];
};

void tsr_reassembly_init(struct tsr_reassembly *reassembly, uint8_t *message, size_t message_cap);

/* Whether the fragment belongs to the message under way. */
bool tsr_reassembly_matches(const struct tsr_reassembly *reassembly, const struct tsr_fragment *fragment);

/* Forget what is under way and begin the fragment's message.
 * TSR_ERR_NOBUF if it cannot fit message_cap; then nothing is under way. */
enum tsr_status tsr_reassembly_begin(struct tsr_reassembly *reassembly, const struct tsr_fragment *fragment);

/* Add a fragment of the message under way. TSR_OK when all have come (also on
 * a repetition afterwards), TSR_AGAIN while some are missing; TSR_ERR_SIZE if
 * it contradicts the fragments before it: it is dropped. */
enum tsr_status tsr_reassembly_add(struct tsr_reassembly *reassembly, const struct tsr_fragment *fragment);

bool tsr_reassembly_complete(const struct tsr_reassembly *reassembly);

#endif

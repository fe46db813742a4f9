/*
 * Messages: what travels end to end, sealed once by its origin.
 *
 *   octets   1      1        4          0..65535     8
 *           kind  key use  counter    sealed body   tag
 *
 * Sealed with AES-CCM* under the key that origin and destination share:
 *   nonce  origin u16 | destination u16 | counter u32 | kind u8 | 0 x 4
 *   AAD    origin u16 | destination u16 | kind u8 | key use u8 | counter u32
 * Relays forward fragments of it without a key. A counter is used once per
 * origin and key; it also identifies the message for its acknowledgement.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_WIRE_MESSAGE_H
#define TSR_WIRE_MESSAGE_H

#include <stddef.h>
#include <stdint.h>

#include "tsr/wire/ccm.h"

#define TSR_MESSAGE_HEADER_LEN 6u
#define TSR_MESSAGE_OVERHEAD_LEN (TSR_MESSAGE_HEADER_LEN + TSR_CCM_TAG_LEN)

enum tsr_message_kind {
    TSR_MESSAGE_WAKE = 1,   /* lead to wing: capture with me */
    TSR_MESSAGE_VIEW = 2,   /* wing to lead: my view of that capture */
    TSR_MESSAGE_MAP = 3,    /* lead or binocular node to sink */
    TSR_MESSAGE_STATUS = 4, /* receiver of a message to its origin */
    TSR_MESSAGE_EVENT = 5   /* lead or binocular node to sink: what its depth rules found */
};

enum tsr_key_use {
    TSR_KEY_NODE = 1, /* shared by a node and the sink alone */
    TSR_KEY_PAIR = 2  /* shared by a lead and its wing */
};

struct tsr_message_header {
    uint8_t kind;         /* enum tsr_message_kind */
    uint8_t key_use;      /* enum tsr_key_use */
    uint16_t origin;      /* who sealed it */
    uint16_t destination; /* who opens it */
    uint32_t counter;
};

/*
 * Begin to seal a message whose body of body_len bytes already stands at
 * message + TSR_MESSAGE_HEADER_LEN. Writes the header in front of it; continue
 * with tsr_ccm_update over the body in pieces and tsr_ccm_seal into the
 * TSR_CCM_TAG_LEN bytes behind it.
 *
 * TSR_ERR_NOBUF: message_cap < body_len + TSR_MESSAGE_OVERHEAD_LEN;
 * TSR_ERR_ARG: body_len > TSR_CCM_TEXT_MAX.
 */
enum tsr_status tsr_message_seal_start(struct tsr_ccm *ccm, const struct tsr_message_header *header,
                                       const struct tsr_cipher *cipher, uint8_t *message, size_t message_cap,
                                       size_t body_len);

/* The whole sealing in one call, for short messages. *message_len is filled. */
enum tsr_status tsr_message_seal(const struct tsr_message_header *header, const struct tsr_cipher *cipher,
                                 uint8_t *message, size_t message_cap, size_t body_len, size_t *message_len);

/* Read kind, key use and counter of a message from origin to destination,
 * which the fragments name. TSR_ERR_FORMAT: too short, or an unknown kind or key use. */
enum tsr_status tsr_message_parse(const uint8_t *message, size_t message_len, uint16_t origin, uint16_t destination,
                                  struct tsr_message_header *header);

/* Begin to open a parsed message in place; continue with tsr_ccm_update over
 * the body (message_len - TSR_MESSAGE_OVERHEAD_LEN bytes) and tsr_ccm_open. */
enum tsr_status tsr_message_open_start(struct tsr_ccm *ccm, const struct tsr_message_header *header,
                                       const struct tsr_cipher *cipher, size_t message_len);

/* The whole opening in one call, in place: the body then stands at
 * message + TSR_MESSAGE_HEADER_LEN, *body_len bytes long. TSR_ERR_AUTH: the
 * tag does not verify; the body is zeroed. */
enum tsr_status tsr_message_open(const struct tsr_message_header *header, const struct tsr_cipher *cipher,
                                 uint8_t *message, size_t message_len, size_t *body_len);

#endif

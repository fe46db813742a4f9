/*
 * Gateway link: the framed byte protocol between a gateway node and the sink,
 * the same over a Unix socket, TCP and a serial port.
 *
 * HDLC-like framing as in RFC 1662, section 4: 0x7e ends a frame, 0x7d escapes
 * (the next byte xor 0x20), FCS-16 (appendix C.2) over the unescaped content.
 *
 *   content  type u8 | sequence u16 | body
 *   HELLO    gateway to sink, first:  version u8 | PAN id u16 | gateway u16
 *   UPLINK   gateway to sink:         time u64 (us, gateway's clock) | fragment
 *   ANSWER   sink to gateway:         zero or more of: length u8 | fragment
 *
 * The sink answers each HELLO and each UPLINK with exactly one ANSWER that
 * carries its sequence; the gateway has one frame unanswered at a time and
 * repeats it (same sequence) after TSR_LINK_ANSWER_TIMEOUT_US or a new
 * connection. A repetition is answered again, so nothing depends on which of
 * the two was lost. Fragments are those of fragment.h.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_WIRE_LINK_H
#define TSR_WIRE_LINK_H

#include <stddef.h>
#include <stdint.h>

#include "tsr/base/status.h"
#include "tsr/wire/frame.h"

#define TSR_LINK_VERSION 1u
#define TSR_LINK_HEADER_LEN 3u
#define TSR_LINK_HELLO_LEN 5u
#define TSR_LINK_UPLINK_HEADER_LEN 8u
#define TSR_LINK_DOWNLINKS_MAX 4u /* fragments in one ANSWER */
#define TSR_LINK_BODY_MAX (TSR_LINK_DOWNLINKS_MAX * (1u + TSR_FRAME_PAYLOAD_MAX))
#define TSR_LINK_CONTENT_MAX (TSR_LINK_HEADER_LEN + TSR_LINK_BODY_MAX)
/* Worst case: every byte escaped, both flags. */
#define TSR_LINK_FRAME_MAX (2u * (TSR_LINK_CONTENT_MAX + 2u) + 2u)
#define TSR_LINK_ANSWER_TIMEOUT_US 1000000u

enum tsr_link_type {
    TSR_LINK_HELLO = 1,
    TSR_LINK_UPLINK = 2,
    TSR_LINK_ANSWER = 3
};

struct tsr_link_frame {
    uint8_t type; /* enum tsr_link_type */
    uint16_t sequence;
    const uint8_t *body; /* borrowed */
    size_t body_len;     /* 0..TSR_LINK_BODY_MAX */
};

/* Encode a frame with its flags. TSR_ERR_ARG: body too long or type unknown;
 * TSR_ERR_NOBUF: cap too small (TSR_LINK_FRAME_MAX always suffices). */
enum tsr_status tsr_link_encode(const struct tsr_link_frame *frame, uint8_t *bytes, size_t cap, size_t *len);

/* Decoder of a byte stream; survives any bytes and finds the next frame. */
struct tsr_link_decoder {
    uint8_t content[TSR_LINK_CONTENT_MAX + 2]; /* with the FCS */
    uint16_t len;
    uint8_t escaped;
    uint8_t overrun;
    uint32_t frames;   /* good frames */
    uint32_t rejected; /* frames with a wrong FCS, length or type */
};

void tsr_link_decoder_init(struct tsr_link_decoder *decoder);

/* Feed one byte. TSR_OK: *frame is a frame whose body points into the decoder
 * until the next byte; TSR_AGAIN: none yet; TSR_ERR_FORMAT: one was rejected. */
enum tsr_status tsr_link_decode(struct tsr_link_decoder *decoder, uint8_t byte, struct tsr_link_frame *frame);

#endif

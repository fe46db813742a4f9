/*
 * Framing of the gateway link.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/wire/link.h"

#include <stdbool.h>
#include <string.h>

#include "tsr/base/crc.h"

#define FLAG 0x7eu   /* RFC 1662, 4.1 */
#define ESCAPE 0x7du /* RFC 1662, 4.2 */
#define ESCAPE_XOR 0x20u
#define FCS_LEN 2u

static bool type_is_known(uint8_t type)
{
    return type >= TSR_LINK_HELLO && type <= TSR_LINK_ANSWER;
}

struct stuffer {
    uint8_t *bytes;
    size_t cap;
    size_t len;
    uint16_t crc;
};

/* Append a raw byte; past the end only the length grows. */
static void put_raw(struct stuffer *out, uint8_t byte)
{
    if (out->len < out->cap) {
        out->bytes[out->len] = byte;
    }
    out->len++;
}

static void put(struct stuffer *out, uint8_t byte)
{
    if (byte == FLAG || byte == ESCAPE) {
        put_raw(out, ESCAPE);
        put_raw(out, (uint8_t)(byte ^ ESCAPE_XOR));
    } else {
        put_raw(out, byte);
    }
}

static void put_content(struct stuffer *out, const uint8_t *bytes, size_t len)
{
    out->crc = tsr_crc16(out->crc, bytes, len);
    for (size_t i = 0; i < len; i++) {
        put(out, bytes[i]);
    }
}

enum tsr_status tsr_link_encode(const struct tsr_link_frame *frame, uint8_t *bytes, size_t cap, size_t *len)
{
    if (frame->body_len > TSR_LINK_BODY_MAX || !type_is_known(frame->type)) {
        return TSR_ERR_ARG;
    }
    const uint8_t header[TSR_LINK_HEADER_LEN] = {frame->type, (uint8_t)frame->sequence,
                                                 (uint8_t)(frame->sequence >> 8)};
    struct stuffer out = {bytes, cap, 0, TSR_CRC16_START_HDLC};
    put_raw(&out, FLAG);
    put_content(&out, header, sizeof header);
    put_content(&out, frame->body, frame->body_len);
    uint16_t fcs = (uint16_t)~out.crc;
    put(&out, (uint8_t)fcs);
    put(&out, (uint8_t)(fcs >> 8));
    put_raw(&out, FLAG);
    if (out.len > cap) {
        return TSR_ERR_NOBUF;
    }
    *len = out.len;
    return TSR_OK;
}

void tsr_link_decoder_init(struct tsr_link_decoder *decoder)
{
    memset(decoder, 0, sizeof *decoder);
}

/* A flag came: judge what stands before it. */
static enum tsr_status finish(struct tsr_link_decoder *decoder, struct tsr_link_frame *frame)
{
    uint16_t len = decoder->len;
    bool damaged = decoder->overrun != 0 || decoder->escaped != 0;
    decoder->len = 0;
    decoder->overrun = 0;
    decoder->escaped = 0;
    if (len == 0 && !damaged) {
        return TSR_AGAIN; /* flags between frames */
    }
    if (damaged || len < TSR_LINK_HEADER_LEN + FCS_LEN) {
        decoder->rejected++;
        return TSR_ERR_FORMAT;
    }
    size_t content_len = len - FCS_LEN;
    uint16_t fcs = (uint16_t)~tsr_crc16(TSR_CRC16_START_HDLC, decoder->content, content_len);
    if (decoder->content[content_len] != (uint8_t)fcs || decoder->content[content_len + 1] != (uint8_t)(fcs >> 8) ||
        !type_is_known(decoder->content[0])) {
        decoder->rejected++;
        return TSR_ERR_FORMAT;
    }
    decoder->frames++;
    frame->type = decoder->content[0];
    frame->sequence = (uint16_t)(decoder->content[1] | decoder->content[2] << 8);
    frame->body = decoder->content + TSR_LINK_HEADER_LEN;
    frame->body_len = content_len - TSR_LINK_HEADER_LEN;
    return TSR_OK;
}

enum tsr_status tsr_link_decode(struct tsr_link_decoder *decoder, uint8_t byte, struct tsr_link_frame *frame)
{
    if (byte == FLAG) {
        return finish(decoder, frame);
    }
    if (byte == ESCAPE) {
        decoder->escaped = 1;
        return TSR_AGAIN;
    }
    if (decoder->escaped) {
        byte = (uint8_t)(byte ^ ESCAPE_XOR);
        decoder->escaped = 0;
    }
    if (decoder->len == sizeof decoder->content) {
        decoder->overrun = 1;
        return TSR_AGAIN;
    }
    decoder->content[decoder->len++] = byte;
    return TSR_AGAIN;
}

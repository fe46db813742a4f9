/*
 * The fragment header: cutting a message and reading pieces of one.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/wire/fragment.h"

#include "tsr/base/bytes.h"

#define DISPATCH 0x10u
#define DISPATCH_POLL 0x01u

uint16_t tsr_fragment_count(size_t message_len)
{
    if (message_len == 0 || message_len > (size_t)TSR_FRAGMENT_COUNT_MAX * TSR_FRAGMENT_PIECE_MAX) {
        return 0;
    }
    return (uint16_t)((message_len + TSR_FRAGMENT_PIECE_MAX - 1) / TSR_FRAGMENT_PIECE_MAX);
}

struct tsr_fragment tsr_fragment_of(const uint8_t *message, size_t message_len, uint16_t index)
{
    struct tsr_fragment fragment = {0};
    size_t start = (size_t)index * TSR_FRAGMENT_PIECE_MAX;
    size_t left = message_len - start;
    fragment.ttl = TSR_FRAGMENT_TTL_START;
    fragment.index = index;
    fragment.count = tsr_fragment_count(message_len);
    fragment.piece = message + start;
    fragment.piece_len = (uint8_t)(left < TSR_FRAGMENT_PIECE_MAX ? left : TSR_FRAGMENT_PIECE_MAX);
    return fragment;
}

/* The rules both directions share. */
static bool fields_fit(const struct tsr_fragment *fragment)
{
    if (fragment->count == 0 || fragment->count > TSR_FRAGMENT_COUNT_MAX || fragment->index >= fragment->count ||
        fragment->piece_len == 0 || fragment->piece_len > TSR_FRAGMENT_PIECE_MAX) {
        return false;
    }
    return fragment->index + 1u == fragment->count || fragment->piece_len == TSR_FRAGMENT_PIECE_MAX;
}

enum tsr_status tsr_fragment_write(const struct tsr_fragment *fragment, uint8_t *bytes, size_t cap, size_t *len)
{
    if (!fields_fit(fragment)) {
        return TSR_ERR_ARG;
    }
    if (cap < TSR_FRAGMENT_HEADER_LEN + (size_t)fragment->piece_len) {
        return TSR_ERR_NOBUF;
    }
    struct tsr_writer writer = tsr_writer_make(bytes, cap);
    tsr_write_u8(&writer, (uint8_t)(DISPATCH | (fragment->poll ? DISPATCH_POLL : 0u)));
    tsr_write_u8(&writer, fragment->ttl);
    tsr_write_u16(&writer, fragment->origin);
    tsr_write_u16(&writer, fragment->destination);
    tsr_write_u16(&writer, fragment->message_id);
    tsr_write_u16(&writer, fragment->index);
    tsr_write_u16(&writer, fragment->count);
    tsr_write_span(&writer, fragment->piece, fragment->piece_len);
    *len = writer.at;
    return TSR_OK;
}

enum tsr_status tsr_fragment_read(const uint8_t *bytes, size_t len, struct tsr_fragment *fragment)
{
    if (len == 0) {
        return TSR_ERR_FORMAT;
    }
    struct tsr_reader reader = tsr_reader_make(bytes, len);
    uint8_t dispatch = tsr_read_u8(&reader);
    if ((dispatch & ~DISPATCH_POLL) != DISPATCH) {
        return TSR_ERR_VERSION;
    }
    struct tsr_fragment read;
    read.poll = (dispatch & DISPATCH_POLL) != 0;
    read.ttl = tsr_read_u8(&reader);
    read.origin = tsr_read_u16(&reader);
    read.destination = tsr_read_u16(&reader);
    read.message_id = tsr_read_u16(&reader);
    read.index = tsr_read_u16(&reader);
    read.count = tsr_read_u16(&reader);
    size_t left = tsr_reader_left(&reader);
    if (!tsr_reader_ok(&reader) || left > TSR_FRAGMENT_PIECE_MAX) {
        return TSR_ERR_FORMAT;
    }
    read.piece_len = (uint8_t)left;
    read.piece = tsr_read_span(&reader, left);
    if (!fields_fit(&read)) {
        return TSR_ERR_FORMAT;
    }
    *fragment = read;
    return TSR_OK;
}

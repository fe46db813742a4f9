/*
 * Message bodies.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/wire/body.h"

#include <string.h>

#include "tsr/base/bytes.h"

void tsr_body_write_capture(const struct tsr_body_capture *body, uint8_t bytes[TSR_BODY_WAKE_LEN])
{
    struct tsr_writer writer = tsr_writer_make(bytes, TSR_BODY_WAKE_LEN);
    tsr_write_u16(&writer, body->capture_id);
    tsr_write_u8(&writer, body->attempt);
}

enum tsr_status tsr_body_read_capture(const uint8_t *bytes, size_t len, struct tsr_body_capture *body)
{
    struct tsr_reader reader = tsr_reader_make(bytes, len);
    uint16_t capture_id = tsr_read_u16(&reader);
    uint8_t attempt = tsr_read_u8(&reader);
    if (!tsr_reader_ok(&reader)) {
        return TSR_ERR_FORMAT;
    }
    body->capture_id = capture_id;
    body->attempt = attempt;
    return TSR_OK;
}

void tsr_body_write_map_header(uint64_t capture_time_us, uint16_t capture_id, size_t reference_len,
                               uint8_t bytes[TSR_BODY_MAP_HEADER_LEN])
{
    struct tsr_writer writer = tsr_writer_make(bytes, TSR_BODY_MAP_HEADER_LEN);
    tsr_write_u64(&writer, capture_time_us);
    tsr_write_u16(&writer, capture_id);
    tsr_write_u32(&writer, (uint32_t)reference_len);
}

enum tsr_status tsr_body_read_map(const uint8_t *bytes, size_t len, struct tsr_body_map *body)
{
    struct tsr_reader reader = tsr_reader_make(bytes, len);
    struct tsr_body_map read;
    read.capture_time_us = tsr_read_u64(&reader);
    read.capture_id = tsr_read_u16(&reader);
    read.reference_len = tsr_read_u32(&reader);
    const uint8_t *reference = tsr_read_span(&reader, read.reference_len);
    read.reference = read.reference_len > 0 ? reference : NULL;
    read.map_len = tsr_reader_left(&reader);
    read.map = tsr_read_span(&reader, read.map_len);
    if (!tsr_reader_ok(&reader) || read.map_len == 0) {
        return TSR_ERR_FORMAT;
    }
    *body = read;
    return TSR_OK;
}

enum tsr_status tsr_body_write_events(const struct tsr_body_events *body, uint8_t *bytes, size_t cap, size_t *len)
{
    if (body->count == 0 || body->count > TSR_BODY_EVENTS_MAX) {
        return TSR_ERR_ARG;
    }
    if (cap < TSR_BODY_EVENT_HEADER_LEN + (size_t)body->count * TSR_BODY_EVENT_LEN) {
        return TSR_ERR_NOBUF;
    }
    struct tsr_writer writer = tsr_writer_make(bytes, cap);
    tsr_write_u64(&writer, body->capture_time_us);
    tsr_write_u16(&writer, body->capture_id);
    for (unsigned i = 0; i < body->count; i++) {
        tsr_write_u8(&writer, body->events[i].rule);
        tsr_write_u8(&writer, body->events[i].kind);
        tsr_write_u16(&writer, body->events[i].share_q12);
        tsr_write_u16(&writer, body->events[i].disparity_q8);
    }
    *len = writer.at;
    return TSR_OK;
}

enum tsr_status tsr_body_read_events(const uint8_t *bytes, size_t len, struct tsr_body_events *body)
{
    struct tsr_reader reader = tsr_reader_make(bytes, len);
    struct tsr_body_events read;
    memset(&read, 0, sizeof read);
    read.capture_time_us = tsr_read_u64(&reader);
    read.capture_id = tsr_read_u16(&reader);
    size_t left = tsr_reader_left(&reader);
    if (left == 0 || left % TSR_BODY_EVENT_LEN != 0 || left > TSR_BODY_EVENTS_MAX * TSR_BODY_EVENT_LEN) {
        return TSR_ERR_FORMAT;
    }
    read.count = (uint8_t)(left / TSR_BODY_EVENT_LEN);
    for (unsigned i = 0; i < read.count; i++) {
        struct tsr_body_event *event = &read.events[i];
        event->rule = tsr_read_u8(&reader);
        event->kind = tsr_read_u8(&reader);
        event->share_q12 = tsr_read_u16(&reader);
        event->disparity_q8 = tsr_read_u16(&reader);
        if (event->kind < TSR_EVENT_BEGUN || event->kind > TSR_EVENT_VANISHED ||
            event->share_q12 > TSR_EVENT_SHARE_ONE) {
            return TSR_ERR_FORMAT;
        }
    }
    *body = read;
    return TSR_OK;
}

enum tsr_status tsr_body_write_status(const struct tsr_body_status *body, uint8_t *bytes, size_t cap, size_t *len)
{
    if (body->bitmap_len > TSR_BODY_STATUS_BITMAP_MAX) {
        return TSR_ERR_ARG;
    }
    if (cap < TSR_BODY_STATUS_HEADER_LEN + (size_t)body->bitmap_len) {
        return TSR_ERR_NOBUF;
    }
    struct tsr_writer writer = tsr_writer_make(bytes, cap);
    tsr_write_u16(&writer, body->message_id);
    tsr_write_u8(&writer, body->state);
    tsr_write_u16(&writer, body->first);
    tsr_write_span(&writer, body->bitmap, body->bitmap_len);
    *len = writer.at;
    return TSR_OK;
}

enum tsr_status tsr_body_read_status(const uint8_t *bytes, size_t len, struct tsr_body_status *body)
{
    struct tsr_reader reader = tsr_reader_make(bytes, len);
    struct tsr_body_status read;
    memset(&read, 0, sizeof read);
    read.message_id = tsr_read_u16(&reader);
    read.state = tsr_read_u8(&reader);
    read.first = tsr_read_u16(&reader);
    size_t left = tsr_reader_left(&reader);
    if (!tsr_reader_ok(&reader) || left > TSR_BODY_STATUS_BITMAP_MAX || (read.first & 7u) != 0 ||
        read.state < TSR_DELIVERY_MISSING || read.state > TSR_DELIVERY_REFUSED) {
        return TSR_ERR_FORMAT;
    }
    read.bitmap_len = (uint8_t)left;
    memcpy(read.bitmap, tsr_read_span(&reader, left), left);
    *body = read;
    return TSR_OK;
}

struct tsr_body_status tsr_body_status_of(const struct tsr_reassembly *reassembly, enum tsr_delivery complete_state)
{
    struct tsr_body_status body;
    memset(&body, 0, sizeof body);
    body.message_id = reassembly->message_id;
    body.state = (uint8_t)complete_state;
    if (tsr_reassembly_complete(reassembly)) {
        return body;
    }
    body.state = TSR_DELIVERY_MISSING;
    uint16_t byte_count = (uint16_t)((reassembly->count + 7u) / 8u);
    uint16_t at = 0;
    while (at < byte_count && reassembly->have[at] == 0xff) {
        at++;
    }
    body.first = (uint16_t)(8u * at);
    while (at < byte_count && body.bitmap_len < TSR_BODY_STATUS_BITMAP_MAX) {
        uint8_t missing = (uint8_t)~reassembly->have[at];
        unsigned in_last = reassembly->count - 8u * at; /* fragments this byte stands for */
        if (in_last < 8) {
            missing = (uint8_t)(missing & ((1u << in_last) - 1u));
        }
        body.bitmap[body.bitmap_len++] = missing;
        at++;
    }
    return body;
}

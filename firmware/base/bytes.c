/*
 * Little-endian byte reader and writer.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/base/bytes.h"

#include <string.h>

struct tsr_reader tsr_reader_make(const uint8_t *bytes, size_t len)
{
    struct tsr_reader reader = {bytes, len, 0};
    return reader;
}

size_t tsr_reader_left(const struct tsr_reader *reader)
{
    return reader->at <= reader->len ? reader->len - reader->at : 0;
}

bool tsr_reader_ok(const struct tsr_reader *reader)
{
    return reader->at <= reader->len;
}

const uint8_t *tsr_read_span(struct tsr_reader *reader, size_t len)
{
    if (!tsr_reader_ok(reader) || len > reader->len - reader->at) {
        reader->at = reader->len + 1;
        return NULL;
    }
    const uint8_t *span = reader->bytes + reader->at;
    reader->at += len;
    return span;
}

static uint64_t read_le(struct tsr_reader *reader, size_t len)
{
    const uint8_t *span = tsr_read_span(reader, len);
    uint64_t value = 0;
    if (span != NULL) {
        for (size_t i = len; i > 0; i--) {
            value = value << 8 | span[i - 1];
        }
    }
    return value;
}

uint8_t tsr_read_u8(struct tsr_reader *reader)
{
    return (uint8_t)read_le(reader, 1);
}

uint16_t tsr_read_u16(struct tsr_reader *reader)
{
    return (uint16_t)read_le(reader, 2);
}

uint32_t tsr_read_u32(struct tsr_reader *reader)
{
    return (uint32_t)read_le(reader, 4);
}

uint64_t tsr_read_u64(struct tsr_reader *reader)
{
    return read_le(reader, 8);
}

struct tsr_writer tsr_writer_make(uint8_t *bytes, size_t cap)
{
    struct tsr_writer writer = {bytes, cap, 0};
    return writer;
}

bool tsr_writer_ok(const struct tsr_writer *writer)
{
    return writer->at <= writer->cap;
}

/* Room for len bytes, or NULL and a remembered overrun. */
static uint8_t *claim(struct tsr_writer *writer, size_t len)
{
    if (!tsr_writer_ok(writer) || len > writer->cap - writer->at) {
        writer->at = writer->cap + 1;
        return NULL;
    }
    uint8_t *room = writer->bytes + writer->at;
    writer->at += len;
    return room;
}

static void write_le(struct tsr_writer *writer, uint64_t value, size_t len)
{
    uint8_t *room = claim(writer, len);
    if (room != NULL) {
        for (size_t i = 0; i < len; i++) {
            room[i] = (uint8_t)(value >> (8 * i));
        }
    }
}

void tsr_write_u8(struct tsr_writer *writer, uint8_t value)
{
    write_le(writer, value, 1);
}

void tsr_write_u16(struct tsr_writer *writer, uint16_t value)
{
    write_le(writer, value, 2);
}

void tsr_write_u32(struct tsr_writer *writer, uint32_t value)
{
    write_le(writer, value, 4);
}

void tsr_write_u64(struct tsr_writer *writer, uint64_t value)
{
    write_le(writer, value, 8);
}

void tsr_write_span(struct tsr_writer *writer, const uint8_t *bytes, size_t len)
{
    uint8_t *room = claim(writer, len);
    if (room != NULL && len > 0) {
        memcpy(room, bytes, len);
    }
}

/*
 * Little-endian byte reader and writer over caller memory.
 *
 * Both remember the first overrun instead of failing each call: read or write
 * a whole structure, then ask once with _ok(). After an overrun a reader
 * returns zeros and a writer writes nothing more; no byte outside the buffer
 * is ever touched. IEEE 802.15.4 sends the least significant byte first
 * (IEEE 802.15.4-2015, 4.4), and every Tarsier format follows it.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_BASE_BYTES_H
#define TSR_BASE_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct tsr_reader { /* borrowed bytes, kept while the reader is used */
    const uint8_t *bytes;
    size_t len;
    size_t at; /* next byte to read; > len after an overrun */
};

struct tsr_writer { /* caller's buffer, filled from the front */
    uint8_t *bytes;
    size_t cap;
    size_t at; /* bytes written; > cap after an overrun */
};

struct tsr_reader tsr_reader_make(const uint8_t *bytes, size_t len);
uint8_t tsr_read_u8(struct tsr_reader *reader);
uint16_t tsr_read_u16(struct tsr_reader *reader);
uint32_t tsr_read_u32(struct tsr_reader *reader);
uint64_t tsr_read_u64(struct tsr_reader *reader);
/* The next len bytes inside the buffer, or NULL after an overrun. */
const uint8_t *tsr_read_span(struct tsr_reader *reader, size_t len);
size_t tsr_reader_left(const struct tsr_reader *reader);
bool tsr_reader_ok(const struct tsr_reader *reader);

struct tsr_writer tsr_writer_make(uint8_t *bytes, size_t cap);
void tsr_write_u8(struct tsr_writer *writer, uint8_t value);
void tsr_write_u16(struct tsr_writer *writer, uint16_t value);
void tsr_write_u32(struct tsr_writer *writer, uint32_t value);
void tsr_write_u64(struct tsr_writer *writer, uint64_t value);
void tsr_write_span(struct tsr_writer *writer, const uint8_t *bytes, size_t len);
bool tsr_writer_ok(const struct tsr_writer *writer);

#endif

/*
 * Sealing and opening of end-to-end messages.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/wire/message.h"

#include <string.h>

#include "tsr/base/bytes.h"

#define AAD_LEN 10u

static enum tsr_status start(struct tsr_ccm *ccm, const struct tsr_message_header *header,
                             const struct tsr_cipher *cipher, size_t body_len, int sealing)
{
    uint8_t nonce[TSR_CCM_NONCE_LEN] = {0};
    struct tsr_writer writer = tsr_writer_make(nonce, sizeof nonce);
    tsr_write_u16(&writer, header->origin);
    tsr_write_u16(&writer, header->destination);
    tsr_write_u32(&writer, header->counter);
    tsr_write_u8(&writer, header->kind);

    uint8_t aad[AAD_LEN];
    writer = tsr_writer_make(aad, sizeof aad);
    tsr_write_u16(&writer, header->origin);
    tsr_write_u16(&writer, header->destination);
    tsr_write_u8(&writer, header->kind);
    tsr_write_u8(&writer, header->key_use);
    tsr_write_u32(&writer, header->counter);
    return tsr_ccm_start(ccm, cipher, nonce, aad, AAD_LEN, body_len, sealing);
}

enum tsr_status tsr_message_seal_start(struct tsr_ccm *ccm, const struct tsr_message_header *header,
                                       const struct tsr_cipher *cipher, uint8_t *message, size_t message_cap,
                                       size_t body_len)
{
    if (body_len > TSR_CCM_TEXT_MAX) {
        return TSR_ERR_ARG;
    }
    if (message_cap < body_len + TSR_MESSAGE_OVERHEAD_LEN) {
        return TSR_ERR_NOBUF;
    }
    struct tsr_writer writer = tsr_writer_make(message, TSR_MESSAGE_HEADER_LEN);
    tsr_write_u8(&writer, header->kind);
    tsr_write_u8(&writer, header->key_use);
    tsr_write_u32(&writer, header->counter);
    return start(ccm, header, cipher, body_len, 1);
}

enum tsr_status tsr_message_seal(const struct tsr_message_header *header, const struct tsr_cipher *cipher,
                                 uint8_t *message, size_t message_cap, size_t body_len, size_t *message_len)
{
    struct tsr_ccm ccm;
    enum tsr_status status = tsr_message_seal_start(&ccm, header, cipher, message, message_cap, body_len);
    if (status == TSR_OK) {
        status = tsr_ccm_update(&ccm, message + TSR_MESSAGE_HEADER_LEN, body_len);
    }
    if (status == TSR_OK) {
        status = tsr_ccm_seal(&ccm, message + TSR_MESSAGE_HEADER_LEN + body_len);
    }
    if (status == TSR_OK) {
        *message_len = body_len + TSR_MESSAGE_OVERHEAD_LEN;
    }
    return status;
}

enum tsr_status tsr_message_parse(const uint8_t *message, size_t message_len, uint16_t origin, uint16_t destination,
                                  struct tsr_message_header *header)
{
    if (message_len < TSR_MESSAGE_OVERHEAD_LEN) {
        return TSR_ERR_FORMAT;
    }
    struct tsr_reader reader = tsr_reader_make(message, message_len);
    struct tsr_message_header read;
    read.kind = tsr_read_u8(&reader);
    read.key_use = tsr_read_u8(&reader);
    read.counter = tsr_read_u32(&reader);
    read.origin = origin;
    read.destination = destination;
    if (read.kind < TSR_MESSAGE_WAKE || read.kind > TSR_MESSAGE_EVENT ||
        (read.key_use != TSR_KEY_NODE && read.key_use != TSR_KEY_PAIR)) {
        return TSR_ERR_FORMAT;
    }
    *header = read;
    return TSR_OK;
}

enum tsr_status tsr_message_open_start(struct tsr_ccm *ccm, const struct tsr_message_header *header,
                                       const struct tsr_cipher *cipher, size_t message_len)
{
    if (message_len < TSR_MESSAGE_OVERHEAD_LEN) {
        return TSR_ERR_FORMAT;
    }
    return start(ccm, header, cipher, message_len - TSR_MESSAGE_OVERHEAD_LEN, 0);
}

enum tsr_status tsr_message_open(const struct tsr_message_header *header, const struct tsr_cipher *cipher,
                                 uint8_t *message, size_t message_len, size_t *body_len)
{
    struct tsr_ccm ccm;
    enum tsr_status status = tsr_message_open_start(&ccm, header, cipher, message_len);
    if (status != TSR_OK) {
        return status;
    }
    size_t len = message_len - TSR_MESSAGE_OVERHEAD_LEN;
    uint8_t *body = message + TSR_MESSAGE_HEADER_LEN;
    status = tsr_ccm_update(&ccm, body, len);
    if (status == TSR_OK) {
        status = tsr_ccm_open(&ccm, body + len);
    }
    if (status != TSR_OK) {
        memset(body, 0, len);
        return status;
    }
    *body_len = len;
    return TSR_OK;
}

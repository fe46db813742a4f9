/*
 * IEEE 802.15.4 data frames with frame security.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/wire/frame.h"

#include <string.h>

#include "tsr/base/bytes.h"
#include "tsr/base/crc.h"
#include "tsr/wire/address.h"

_Static_assert(TSR_FRAME_PAYLOAD_MAX == 102u, "docs/wire_format.md counts on 102 bytes");

/* Frame control field, IEEE 802.15.4-2015, 7.2.2. */
#define FCF_TYPE_DATA 0x0001u
#define FCF_TYPE_ACK 0x0002u
#define FCF_SECURITY (1u << 3)
#define FCF_ACK_REQUEST (1u << 5)
#define FCF_PAN_ID_COMPRESSION (1u << 6)
#define FCF_DESTINATION_SHORT (2u << 10)
#define FCF_VERSION_2006 (1u << 12)
#define FCF_SOURCE_SHORT (2u << 14)
#define FCF_OURS                                                                                                       \
    (FCF_TYPE_DATA | FCF_SECURITY | FCF_PAN_ID_COMPRESSION | FCF_DESTINATION_SHORT | FCF_VERSION_2006 |                \
     FCF_SOURCE_SHORT)

#define SECURITY_LEVEL_ENC_MIC_64 6u                           /* Table 9-6 */
#define SECURITY_CONTROL (SECURITY_LEVEL_ENC_MIC_64 | 1u << 3) /* key identifier mode 1, 9.4.2 */
#define KEY_INDEX_LINK 1u
#define COUNTER_EXHAUSTED UINT32_C(0xffffffff)

/* Nonce of frame security, 9.3.3.1: EUI-64 and counter, most significant byte first. */
static void make_nonce(const struct tsr_frame_header *header, uint8_t nonce[TSR_CCM_NONCE_LEN])
{
    tsr_eui64_derive(header->pan_id, header->source, nonce);
    for (unsigned i = 0; i < 4; i++) {
        nonce[TSR_EUI64_LEN + i] = (uint8_t)(header->counter >> (24 - 8 * i));
    }
    nonce[TSR_CCM_NONCE_LEN - 1] = SECURITY_LEVEL_ENC_MIC_64;
}

static void append_fcs(uint8_t *psdu, size_t len)
{
    uint16_t fcs = tsr_crc16(TSR_CRC16_START_802154, psdu, len);
    psdu[len] = (uint8_t)fcs;
    psdu[len + 1] = (uint8_t)(fcs >> 8);
}

static bool fcs_is_right(const uint8_t *psdu, size_t psdu_len)
{
    size_t len = psdu_len - TSR_FRAME_FCS_LEN;
    uint16_t fcs = tsr_crc16(TSR_CRC16_START_802154, psdu, len);
    return psdu[len] == (uint8_t)fcs && psdu[len + 1] == (uint8_t)(fcs >> 8);
}

enum tsr_status tsr_frame_seal(const struct tsr_frame_header *header, const struct tsr_cipher *link_cipher,
                               const uint8_t *payload, size_t payload_len, uint8_t *psdu, size_t psdu_cap,
                               size_t *psdu_len)
{
    if (payload_len > TSR_FRAME_PAYLOAD_MAX || header->counter == COUNTER_EXHAUSTED) {
        return TSR_ERR_ARG;
    }
    if (psdu_cap < payload_len + TSR_FRAME_OVERHEAD_LEN) {
        return TSR_ERR_NOBUF;
    }
    struct tsr_writer writer = tsr_writer_make(psdu, psdu_cap);
    tsr_write_u16(&writer, (uint16_t)(FCF_OURS | (header->ack_request ? FCF_ACK_REQUEST : 0u)));
    tsr_write_u8(&writer, header->sequence);
    tsr_write_u16(&writer, header->pan_id);
    tsr_write_u16(&writer, header->destination);
    tsr_write_u16(&writer, header->source);
    tsr_write_u8(&writer, SECURITY_CONTROL);
    tsr_write_u32(&writer, header->counter);
    tsr_write_u8(&writer, KEY_INDEX_LINK);
    tsr_write_span(&writer, payload, payload_len);

    uint8_t nonce[TSR_CCM_NONCE_LEN];
    make_nonce(header, nonce);
    struct tsr_ccm ccm;
    uint8_t *text = psdu + TSR_FRAME_HEADER_LEN;
    enum tsr_status status = tsr_ccm_start(&ccm, link_cipher, nonce, psdu, TSR_FRAME_HEADER_LEN, payload_len, 1);
    if (status == TSR_OK) {
        status = tsr_ccm_update(&ccm, text, payload_len);
    }
    if (status == TSR_OK) {
        status = tsr_ccm_seal(&ccm, text + payload_len);
    }
    if (status != TSR_OK) {
        return status;
    }
    append_fcs(psdu, TSR_FRAME_HEADER_LEN + payload_len + TSR_CCM_TAG_LEN);
    *psdu_len = payload_len + TSR_FRAME_OVERHEAD_LEN;
    return TSR_OK;
}

enum tsr_status tsr_frame_parse(const uint8_t *psdu, size_t psdu_len, struct tsr_frame_header *header)
{
    if (psdu_len < TSR_FRAME_OVERHEAD_LEN || psdu_len > TSR_FRAME_PSDU_MAX || !fcs_is_right(psdu, psdu_len)) {
        return TSR_ERR_FORMAT;
    }
    struct tsr_reader reader = tsr_reader_make(psdu, psdu_len);
    uint16_t fcf = tsr_read_u16(&reader);
    struct tsr_frame_header read;
    read.sequence = tsr_read_u8(&reader);
    read.ack_request = (fcf & FCF_ACK_REQUEST) != 0;
    read.pan_id = tsr_read_u16(&reader);
    read.destination = tsr_read_u16(&reader);
    read.source = tsr_read_u16(&reader);
    uint8_t control = tsr_read_u8(&reader);
    read.counter = tsr_read_u32(&reader);
    uint8_t key_index = tsr_read_u8(&reader);
    if ((fcf & ~FCF_ACK_REQUEST) != FCF_OURS || control != SECURITY_CONTROL || key_index != KEY_INDEX_LINK ||
        read.counter == COUNTER_EXHAUSTED) {
        return TSR_ERR_FORMAT;
    }
    *header = read;
    return TSR_OK;
}

enum tsr_status tsr_frame_open(const uint8_t *psdu, size_t psdu_len, const struct tsr_cipher *link_cipher,
                               uint8_t *payload, size_t payload_cap, size_t *payload_len)
{
    struct tsr_frame_header header;
    enum tsr_status status = tsr_frame_parse(psdu, psdu_len, &header);
    if (status != TSR_OK) {
        return status;
    }
    size_t len = psdu_len - TSR_FRAME_OVERHEAD_LEN;
    if (len > payload_cap) {
        return TSR_ERR_NOBUF;
    }
    uint8_t nonce[TSR_CCM_NONCE_LEN];
    make_nonce(&header, nonce);
    struct tsr_ccm ccm;
    status = tsr_ccm_start(&ccm, link_cipher, nonce, psdu, TSR_FRAME_HEADER_LEN, len, 0);
    if (status == TSR_OK) {
        memcpy(payload, psdu + TSR_FRAME_HEADER_LEN, len);
        status = tsr_ccm_update(&ccm, payload, len);
        if (status == TSR_OK) {
            status = tsr_ccm_open(&ccm, psdu + TSR_FRAME_HEADER_LEN + len);
        }
        if (status != TSR_OK) {
            memset(payload, 0, len);
            return status;
        }
        *payload_len = len;
    }
    return status;
}

void tsr_frame_write_ack(uint8_t sequence, uint8_t psdu[TSR_FRAME_ACK_LEN])
{
    psdu[0] = (uint8_t)FCF_TYPE_ACK;
    psdu[1] = 0;
    psdu[2] = sequence;
    append_fcs(psdu, TSR_FRAME_ACK_LEN - TSR_FRAME_FCS_LEN);
}

bool tsr_frame_is_ack(const uint8_t *psdu, size_t psdu_len, uint8_t *sequence)
{
    if (psdu_len != TSR_FRAME_ACK_LEN || psdu[0] != FCF_TYPE_ACK || psdu[1] != 0 || !fcs_is_right(psdu, psdu_len)) {
        return false;
    }
    *sequence = psdu[2];
    return true;
}

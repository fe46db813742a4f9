/*
 * Any bytes as a received PSDU: parse, open, acknowledgement. And the same
 * bytes as a payload: what is sealed opens to itself.
 *
 *   tools/fuzz wire_frame
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "mbedtls_aes.h"
#include "tsr/wire/frame.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len);

static void require_frame(int condition)
{
    if (!condition) {
        abort();
    }
}

static void seal_and_open(const struct tsr_cipher *cipher, const uint8_t *bytes, size_t len)
{
    uint8_t psdu[TSR_FRAME_PSDU_MAX];
    uint8_t payload[TSR_FRAME_PAYLOAD_MAX];
    struct tsr_frame_header header = {0, true, 0xbeef, 2, 3, 1};
    struct tsr_frame_header read;
    size_t psdu_len = 0;
    size_t payload_len = 0;
    const size_t fits = len < TSR_FRAME_PAYLOAD_MAX ? len : TSR_FRAME_PAYLOAD_MAX;
    if (len >= sizeof header.counter) {
        memcpy(&header.counter, bytes, sizeof header.counter);
    }
    const enum tsr_status status = tsr_frame_seal(&header, cipher, bytes, fits, psdu, sizeof psdu, &psdu_len);
    require_frame(status == (header.counter == UINT32_MAX ? TSR_ERR_ARG : TSR_OK));
    if (status == TSR_OK) {
        require_frame(tsr_frame_parse(psdu, psdu_len, &read) == TSR_OK && read.counter == header.counter);
        require_frame(tsr_frame_open(psdu, psdu_len, cipher, payload, sizeof payload, &payload_len) == TSR_OK);
        require_frame(payload_len == fits && (fits == 0 || memcmp(payload, bytes, fits) == 0));
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len)
{
    const struct tsr_cipher cipher = test_cipher(1);
    uint8_t payload[TSR_FRAME_PAYLOAD_MAX];
    size_t payload_len = 0;
    struct tsr_frame_header header;
    uint8_t sequence = 0;
    const bool parsed = tsr_frame_parse(bytes, len, &header) == TSR_OK;
    const enum tsr_status opened = tsr_frame_open(bytes, len, &cipher, payload, sizeof payload, &payload_len);
    require_frame(parsed || opened == TSR_ERR_FORMAT);
    require_frame(opened != TSR_OK || payload_len + TSR_FRAME_OVERHEAD_LEN == len);
    require_frame(!(tsr_frame_is_ack(bytes, len, &sequence) && parsed));
    seal_and_open(&cipher, bytes, len);
    return 0;
}

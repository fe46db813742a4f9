/*
 * Any bytes as the stream of a gateway link. Each frame it yields encodes and
 * decodes to itself; after any bytes a good frame comes through.
 *
 *   tools/fuzz wire_link
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "tsr/wire/link.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len);

static void require_link(int condition)
{
    if (!condition) {
        abort();
    }
}

/* Encode a frame, feed it to a decoder: the last byte yields it again. (The first one, a flag, may end what was
 * before.) */
static void pass_frame(struct tsr_link_decoder *decoder, const struct tsr_link_frame *frame)
{
    uint8_t encoded[TSR_LINK_FRAME_MAX];
    size_t encoded_len = 0;
    struct tsr_link_frame read;
    require_link(tsr_link_encode(frame, encoded, sizeof encoded, &encoded_len) == TSR_OK);
    for (size_t i = 0; i < encoded_len; i++) {
        const enum tsr_status status = tsr_link_decode(decoder, encoded[i], &read);
        require_link(i == 0 || (status == TSR_OK) == (i + 1 == encoded_len));
    }
    require_link(read.type == frame->type && read.sequence == frame->sequence && read.body_len == frame->body_len);
    require_link(read.body_len == 0 || memcmp(read.body, frame->body, read.body_len) == 0);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len)
{
    struct tsr_link_decoder decoder;
    struct tsr_link_decoder other;
    uint32_t good = 0;
    uint32_t bad = 0;
    tsr_link_decoder_init(&decoder);
    tsr_link_decoder_init(&other);
    for (size_t i = 0; i < len; i++) {
        struct tsr_link_frame frame;
        const enum tsr_status status = tsr_link_decode(&decoder, bytes[i], &frame);
        if (status == TSR_OK) {
            good++;
            pass_frame(&other, &frame);
        } else {
            bad += status == TSR_ERR_FORMAT ? 1 : 0;
            require_link(status == TSR_AGAIN || status == TSR_ERR_FORMAT);
        }
    }
    require_link(decoder.frames == good && decoder.rejected == bad);
    const struct tsr_link_frame last = {TSR_LINK_ANSWER, 7, bytes, len < TSR_LINK_BODY_MAX ? len : TSR_LINK_BODY_MAX};
    pass_frame(&decoder, &last);
    return 0;
}

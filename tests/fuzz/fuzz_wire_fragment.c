/*
 * A row of fragments, each after its length in one byte: read, written back,
 * reassembled, answered.
 *
 *   tools/fuzz wire_fragment
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "tsr/wire/body.h"
#include "tsr/wire/fragment.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len);

#define ROOM_CAP 700u /* seven pieces and a bit */

static void require_fragment(int condition)
{
    if (!condition) {
        abort();
    }
}

static void write_back(const struct tsr_fragment *fragment, const uint8_t *bytes, size_t len)
{
    uint8_t again[TSR_FRAME_PAYLOAD_MAX];
    size_t again_len = 0;
    require_fragment(tsr_fragment_write(fragment, again, sizeof again, &again_len) == TSR_OK);
    require_fragment(again_len == len && memcmp(again, bytes, len) == 0);
}

static void check_answer(const struct tsr_reassembly *reassembly)
{
    const struct tsr_body_status status = tsr_body_status_of(reassembly, TSR_DELIVERY_COMMITTED);
    require_fragment((status.state == TSR_DELIVERY_COMMITTED) == tsr_reassembly_complete(reassembly));
    for (unsigned i = 0; i < 8u * status.bitmap_len; i++) {
        const unsigned index = status.first + i;
        const bool missing = (status.bitmap[i / 8] >> i % 8 & 1) != 0;
        require_fragment(!missing || index < reassembly->count);
        if (index < reassembly->count) {
            require_fragment(missing != ((reassembly->have[index / 8] >> index % 8 & 1) != 0));
        }
    }
}

static void take_fragment(struct tsr_reassembly *reassembly, const struct tsr_fragment *fragment)
{
    const uint16_t received = reassembly->received;
    if (!tsr_reassembly_matches(reassembly, fragment)) {
        if (tsr_reassembly_begin(reassembly, fragment) != TSR_OK) {
            require_fragment(!tsr_reassembly_matches(reassembly, fragment));
            return;
        }
    }
    const enum tsr_status status = tsr_reassembly_add(reassembly, fragment);
    require_fragment(status == TSR_OK || status == TSR_AGAIN || status == TSR_ERR_SIZE);
    require_fragment(status != TSR_OK || (reassembly->message_len > 0 && reassembly->message_len <= ROOM_CAP));
    require_fragment(status >= TSR_OK || reassembly->received == received || reassembly->received == 0);
    check_answer(reassembly);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len)
{
    struct tsr_reassembly reassembly;
    uint8_t *room = malloc(ROOM_CAP);
    require_fragment(room != NULL);
    tsr_reassembly_init(&reassembly, room, ROOM_CAP);
    for (size_t at = 0; at < len;) {
        const size_t left = len - at - 1;
        const size_t fragment_len = bytes[at] < left ? bytes[at] : left;
        struct tsr_fragment fragment;
        at++;
        if (tsr_fragment_read(bytes + at, fragment_len, &fragment) == TSR_OK) {
            write_back(&fragment, bytes + at, fragment_len);
            take_fragment(&reassembly, &fragment);
        }
        at += fragment_len;
    }
    free(room);
    return 0;
}

/*
 * Reassembly of one message from its fragments, in any order.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "tsr/wire/fragment.h"

void tsr_reassembly_init(struct tsr_reassembly *reassembly, uint8_t *message, size_t message_cap)
{
    memset(reassembly, 0, sizeof *reassembly);
    reassembly->message = message;
    reassembly->message_cap = message_cap;
}

bool tsr_reassembly_matches(const struct tsr_reassembly *reassembly, const struct tsr_fragment *fragment)
{
    return reassembly->count != 0 && reassembly->origin == fragment->origin &&
           reassembly->destination == fragment->destination && reassembly->message_id == fragment->message_id;
}

enum tsr_status tsr_reassembly_begin(struct tsr_reassembly *reassembly, const struct tsr_fragment *fragment)
{
    reassembly->count = 0;
    reassembly->received = 0;
    reassembly->message_len = 0;
    /* All pieces but the last are full; the last has at least one byte. */
    if ((size_t)(fragment->count - 1u) * TSR_FRAGMENT_PIECE_MAX + 1 > reassembly->message_cap) {
        return TSR_ERR_NOBUF;
    }
    reassembly->origin = fragment->origin;
    reassembly->destination = fragment->destination;
    reassembly->message_id = fragment->message_id;
    reassembly->count = fragment->count;
    memset(reassembly->have, 0, sizeof reassembly->have);
    return TSR_OK;
}

enum tsr_status tsr_reassembly_add(struct tsr_reassembly *reassembly, const struct tsr_fragment *fragment)
{
    size_t start = (size_t)fragment->index * TSR_FRAGMENT_PIECE_MAX;
    if (reassembly->count == 0 || fragment->count != reassembly->count || fragment->index >= reassembly->count ||
        start + fragment->piece_len > reassembly->message_cap) {
        return TSR_ERR_SIZE;
    }
    uint8_t bit = (uint8_t)(1u << (fragment->index & 7u));
    uint8_t *have = &reassembly->have[fragment->index >> 3];
    if ((*have & bit) == 0) {
        memcpy(reassembly->message + start, fragment->piece, fragment->piece_len);
        *have |= bit;
        reassembly->received++;
        if (fragment->index + 1u == fragment->count) {
            reassembly->message_len = start + fragment->piece_len;
        }
    }
    return tsr_reassembly_complete(reassembly) ? TSR_OK : TSR_AGAIN;
}

bool tsr_reassembly_complete(const struct tsr_reassembly *reassembly)
{
    return reassembly->count != 0 && reassembly->received == reassembly->count;
}

/*
 * The AES-128 block operation: the seam where a chip's AES or a library's
 * goes in. Modes (CCM*) are built over it in wire/.
 *
 * Only the forward cipher is needed (FIPS 197, section 5.1): CCM* uses it for
 * both directions.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_BASE_AES_H
#define TSR_BASE_AES_H

#include <stdint.h>

#include "tsr/base/status.h"

#define TSR_AES_BLOCK_LEN 16
#define TSR_AES_KEY_LEN 16

/* The largest expanded key any implementation keeps: Mbed TLS 2.28's
 * mbedtls_aes_context, 4 + 8 + 68 * 4 bytes on a 64-bit host. */
#define TSR_AES_STATE_LEN 288

/* An expanded key in caller memory; its content belongs to the implementation. */
struct tsr_aes_key {
    uint64_t state[TSR_AES_STATE_LEN / 8];
};

struct tsr_aes_ops {
    /* Expand key into *expanded. TSR_OK or TSR_ERR_IO (hardware failed). */
    enum tsr_status (*expand)(struct tsr_aes_key *expanded, const uint8_t key[TSR_AES_KEY_LEN]);
    /* out = AES(key, in); in and out may be the same block. TSR_OK or TSR_ERR_IO. */
    enum tsr_status (*encrypt)(const struct tsr_aes_key *expanded, const uint8_t in[TSR_AES_BLOCK_LEN],
                               uint8_t out[TSR_AES_BLOCK_LEN]);
};

#endif

/*
 * AES-128 blocks by Mbed TLS.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/hal/mps2_aes.h"

#include <string.h>

#include "mbedtls/aes.h"

#define KEY_BITS (8u * TSR_AES_KEY_LEN)
#define ROUNDS 10 /* FIPS 197, figure 4 */
#define ROUND_KEYS_LEN ((size_t)(ROUNDS + 1) * TSR_AES_BLOCK_LEN)

_Static_assert(ROUND_KEYS_LEN <= TSR_AES_STATE_LEN, "a tsr_aes_key holds the round keys");

/* An mbedtls_aes_context points into itself and a tsr_aes_key may be copied
 * like any struct: the round keys are kept, the context is made when needed. */
static enum tsr_status expand(struct tsr_aes_key *expanded, const uint8_t key[TSR_AES_KEY_LEN])
{
    mbedtls_aes_context context;
    mbedtls_aes_init(&context);
    enum tsr_status status = TSR_ERR_IO;
    if (mbedtls_aes_setkey_enc(&context, key, KEY_BITS) == 0 && context.nr == ROUNDS) {
        memcpy(expanded->state, context.rk, ROUND_KEYS_LEN);
        status = TSR_OK;
    }
    mbedtls_aes_free(&context);
    return status;
}

static enum tsr_status encrypt(const struct tsr_aes_key *expanded, const uint8_t in[TSR_AES_BLOCK_LEN],
                               uint8_t out[TSR_AES_BLOCK_LEN])
{
    mbedtls_aes_context context;
    context.nr = ROUNDS;
    context.rk = (uint32_t *)(uintptr_t)expanded->state; /* read only: mbedtls_internal_aes_encrypt */
    return mbedtls_internal_aes_encrypt(&context, in, out) == 0 ? TSR_OK : TSR_ERR_IO;
}

const struct tsr_aes_ops tsr_mps2_aes = {expand, encrypt};

/*
 * The AES block operation of tsr/base/aes.h by Mbed TLS, for C tests; C++
 * tests have tsr/host/aes.h.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TEST_MBEDTLS_AES_H
#define TSR_TEST_MBEDTLS_AES_H

#include <mbedtls/aes.h>
#include <string.h>

#include "tsr/base/aes.h"
#include "tsr/wire/ccm.h"

/* A tsr_aes_key may be copied, an mbedtls_aes_context points into itself: keep
 * the key, expand it for each block. */
static inline enum tsr_status test_aes_expand(struct tsr_aes_key *expanded, const uint8_t key[TSR_AES_KEY_LEN])
{
    memcpy(expanded->state, key, TSR_AES_KEY_LEN);
    return TSR_OK;
}

static inline enum tsr_status test_aes_encrypt(const struct tsr_aes_key *expanded, const uint8_t in[TSR_AES_BLOCK_LEN],
                                               uint8_t out[TSR_AES_BLOCK_LEN])
{
    mbedtls_aes_context context;
    mbedtls_aes_init(&context);
    int failed = mbedtls_aes_setkey_enc(&context, (const uint8_t *)expanded->state, 8 * TSR_AES_KEY_LEN);
    if (failed == 0) {
        failed = mbedtls_aes_crypt_ecb(&context, MBEDTLS_AES_ENCRYPT, in, out);
    }
    mbedtls_aes_free(&context);
    return failed == 0 ? TSR_OK : TSR_ERR_IO;
}

static const struct tsr_aes_ops test_aes_ops = {test_aes_expand, test_aes_encrypt};

/* A cipher under the key first, first + 1, ... */
static inline struct tsr_cipher test_cipher(uint8_t first)
{
    struct tsr_cipher cipher;
    uint8_t key[TSR_AES_KEY_LEN];
    for (unsigned i = 0; i < sizeof key; i++) {
        key[i] = (uint8_t)(first + i);
    }
    memset(&cipher, 0, sizeof cipher);
    (void)tsr_cipher_init(&cipher, &test_aes_ops, key);
    return cipher;
}

#endif

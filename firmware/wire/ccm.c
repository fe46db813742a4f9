/*
 * AES-CCM*: CBC-MAC for authenticity, counter mode for secrecy, one pass.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/wire/ccm.h"

#include <string.h>

#define LENGTH_FIELD_LEN 2u /* L, RFC 3610 section 2.1 */
#define FLAG_HAS_AAD 0x40u

enum tsr_status tsr_cipher_init(struct tsr_cipher *cipher, const struct tsr_aes_ops *ops,
                                const uint8_t key[TSR_AES_KEY_LEN])
{
    if (cipher == NULL || ops == NULL || key == NULL) {
        return TSR_ERR_ARG;
    }
    cipher->ops = ops;
    return ops->expand(&cipher->key, key);
}

static enum tsr_status encrypt_block(const struct tsr_cipher *cipher, uint8_t block[TSR_AES_BLOCK_LEN])
{
    return cipher->ops->encrypt(&cipher->key, block, block);
}

static void put_be16(uint8_t *bytes, size_t value)
{
    bytes[0] = (uint8_t)(value >> 8);
    bytes[1] = (uint8_t)value;
}

/* Absorb the authenticated data, its length first, padded with zeros (RFC 3610, 2.2). */
static enum tsr_status absorb_aad(struct tsr_ccm *ccm, const uint8_t *aad, size_t aad_len)
{
    if (aad_len == 0) {
        return TSR_OK;
    }
    uint8_t length[2];
    put_be16(length, aad_len);
    ccm->mac[0] ^= length[0];
    ccm->mac[1] ^= length[1];
    size_t at = 2;
    for (size_t i = 0; i < aad_len; i++) {
        if (at == TSR_AES_BLOCK_LEN) {
            enum tsr_status status = encrypt_block(ccm->cipher, ccm->mac);
            if (status != TSR_OK) {
                return status;
            }
            at = 0;
        }
        ccm->mac[at++] ^= aad[i];
    }
    return encrypt_block(ccm->cipher, ccm->mac);
}

enum tsr_status tsr_ccm_start(struct tsr_ccm *ccm, const struct tsr_cipher *cipher,
                              const uint8_t nonce[TSR_CCM_NONCE_LEN], const uint8_t *aad, size_t aad_len,
                              size_t text_len, int sealing)
{
    if (ccm == NULL || cipher == NULL || nonce == NULL || (aad == NULL && aad_len > 0) || aad_len > TSR_CCM_AAD_MAX ||
        text_len > TSR_CCM_TEXT_MAX) {
        return TSR_ERR_ARG;
    }
    ccm->cipher = cipher;
    ccm->left = (uint32_t)text_len;
    ccm->used = 0;
    ccm->sealing = sealing != 0;
    /* B_0: flags, nonce, length of the text. */
    ccm->mac[0] =
        (uint8_t)((aad_len > 0 ? FLAG_HAS_AAD : 0u) | (TSR_CCM_TAG_LEN - 2u) / 2u << 3 | (LENGTH_FIELD_LEN - 1u));
    memcpy(ccm->mac + 1, nonce, TSR_CCM_NONCE_LEN);
    put_be16(ccm->mac + 1 + TSR_CCM_NONCE_LEN, text_len);
    /* A_0: flags, nonce, block counter. */
    ccm->counter_block[0] = LENGTH_FIELD_LEN - 1u;
    memcpy(ccm->counter_block + 1, nonce, TSR_CCM_NONCE_LEN);
    put_be16(ccm->counter_block + 1 + TSR_CCM_NONCE_LEN, 0);
    enum tsr_status status = encrypt_block(cipher, ccm->mac);
    return status == TSR_OK ? absorb_aad(ccm, aad, aad_len) : status;
}

static enum tsr_status next_stream_block(struct tsr_ccm *ccm)
{
    uint8_t *counter = ccm->counter_block + 1 + TSR_CCM_NONCE_LEN;
    put_be16(counter, ((size_t)counter[0] << 8 | counter[1]) + 1u);
    return ccm->cipher->ops->encrypt(&ccm->cipher->key, ccm->counter_block, ccm->stream);
}

enum tsr_status tsr_ccm_update(struct tsr_ccm *ccm, uint8_t *text, size_t len)
{
    if (len > ccm->left) {
        return TSR_ERR_SIZE;
    }
    for (size_t i = 0; i < len; i++) {
        if (ccm->used == 0) {
            enum tsr_status status = next_stream_block(ccm);
            if (status != TSR_OK) {
                return status;
            }
        }
        uint8_t plain = ccm->sealing ? text[i] : (uint8_t)(text[i] ^ ccm->stream[ccm->used]);
        text[i] = (uint8_t)(text[i] ^ ccm->stream[ccm->used]);
        ccm->mac[ccm->used] ^= plain;
        ccm->used++;
        ccm->left--;
        if (ccm->used == TSR_AES_BLOCK_LEN || ccm->left == 0) {
            enum tsr_status status = encrypt_block(ccm->cipher, ccm->mac);
            if (status != TSR_OK) {
                return status;
            }
            ccm->used = 0;
        }
    }
    return TSR_OK;
}

/* The encrypted tag, T xor first bytes of E(A_0). */
static enum tsr_status make_tag(struct tsr_ccm *ccm, uint8_t tag[TSR_CCM_TAG_LEN])
{
    if (ccm->left > 0) {
        return TSR_ERR_SIZE;
    }
    put_be16(ccm->counter_block + 1 + TSR_CCM_NONCE_LEN, 0);
    enum tsr_status status = ccm->cipher->ops->encrypt(&ccm->cipher->key, ccm->counter_block, ccm->stream);
    if (status != TSR_OK) {
        return status;
    }
    for (size_t i = 0; i < TSR_CCM_TAG_LEN; i++) {
        tag[i] = (uint8_t)(ccm->mac[i] ^ ccm->stream[i]);
    }
    return TSR_OK;
}

enum tsr_status tsr_ccm_seal(struct tsr_ccm *ccm, uint8_t tag[TSR_CCM_TAG_LEN])
{
    return make_tag(ccm, tag);
}

enum tsr_status tsr_ccm_open(struct tsr_ccm *ccm, const uint8_t tag[TSR_CCM_TAG_LEN])
{
    uint8_t expected[TSR_CCM_TAG_LEN];
    enum tsr_status status = make_tag(ccm, expected);
    if (status != TSR_OK) {
        return status;
    }
    uint8_t difference = 0;
    for (size_t i = 0; i < TSR_CCM_TAG_LEN; i++) {
        difference |= (uint8_t)(expected[i] ^ tag[i]);
    }
    return difference == 0 ? TSR_OK : TSR_ERR_AUTH;
}

/*
 * AES-CCM* with an 8-byte tag over the AES block operation.
 *
 * IEEE 802.15.4-2015, Annex B.4 (M = 8, L = 2), which for M > 0 is RFC 3610
 * with a 13-byte nonce. Streaming: one object seals or opens one text in
 * pieces of any size, so that a long message never blocks the radio.
 *
 *     start(nonce, authenticated data) -> update(piece) ... -> seal | open
 *
 * A nonce must never seal two texts under one key; the caller guarantees it.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_WIRE_CCM_H
#define TSR_WIRE_CCM_H

#include <stddef.h>
#include <stdint.h>

#include "tsr/base/aes.h"

#define TSR_CCM_NONCE_LEN 13
#define TSR_CCM_TAG_LEN 8
#define TSR_CCM_AAD_MAX 64                /* ours are at most 15 bytes long */
#define TSR_CCM_TEXT_MAX UINT32_C(0xffff) /* L = 2: the length field has 16 bits */

struct tsr_cipher { /* a block cipher with its expanded key; both kept */
    const struct tsr_aes_ops *ops;
    struct tsr_aes_key key;
};

struct tsr_ccm {
    const struct tsr_cipher *cipher; /* kept until finished */
    uint8_t counter_block[TSR_AES_BLOCK_LEN];
    uint8_t mac[TSR_AES_BLOCK_LEN];
    uint8_t stream[TSR_AES_BLOCK_LEN];
    uint32_t left; /* text bytes still to come */
    uint8_t used;  /* bytes of the current block already processed */
    uint8_t sealing;
};

/* Expand a key. TSR_OK, TSR_ERR_ARG for a null pointer, or the cipher's own error. */
enum tsr_status tsr_cipher_init(struct tsr_cipher *cipher, const struct tsr_aes_ops *ops,
                                const uint8_t key[TSR_AES_KEY_LEN]);

/* Begin a text of text_len bytes, 0 <= text_len <= TSR_CCM_TEXT_MAX, with aad_len <= TSR_CCM_AAD_MAX
 * authenticated bytes (borrowed). sealing: nonzero to encrypt, 0 to decrypt.
 * TSR_ERR_ARG outside these ranges; TSR_ERR_IO from the cipher. */
enum tsr_status tsr_ccm_start(struct tsr_ccm *ccm, const struct tsr_cipher *cipher,
                              const uint8_t nonce[TSR_CCM_NONCE_LEN], const uint8_t *aad, size_t aad_len,
                              size_t text_len, int sealing);

/* Encrypt or decrypt len more bytes in place. What an opening gives is not
 * authentic before tsr_ccm_open says so. TSR_ERR_SIZE if more comes than was announced. */
enum tsr_status tsr_ccm_update(struct tsr_ccm *ccm, uint8_t *text, size_t len);

/* The tag of a sealed text. TSR_ERR_SIZE if text is missing. */
enum tsr_status tsr_ccm_seal(struct tsr_ccm *ccm, uint8_t tag[TSR_CCM_TAG_LEN]);

/* Compare the tag in constant time: TSR_OK or TSR_ERR_AUTH, on which the
 * caller must not use the text. TSR_ERR_SIZE if text is missing. */
enum tsr_status tsr_ccm_open(struct tsr_ccm *ccm, const uint8_t tag[TSR_CCM_TAG_LEN]);

#endif

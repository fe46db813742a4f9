/*
 * Sealing and opening, of messages in the node's pieces and of full frames.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "tsr/wire/frame.h"
#include "tsr/wire/message.h"
#include "workbench.h"

#define PIECE_LEN 256u /* SEAL_BYTES_PER_STEP of the node */
#define TEXT_MAX 60000u
#define FRAMES 8u
#define PAN_ID 0xbeefu

static uint8_t message[TEXT_MAX + TSR_MESSAGE_OVERHEAD_LEN];

/* FIPS 197, appendix C.1: a result that no code of ours has made. */
static void run_block(void)
{
    uint8_t key[TSR_AES_KEY_LEN];
    uint8_t block[TSR_AES_BLOCK_LEN];
    for (unsigned i = 0; i < TSR_AES_BLOCK_LEN; i++) {
        key[i] = (uint8_t)i;
        block[i] = (uint8_t)(i * 0x11u);
    }
    static const uint8_t kExpected[TSR_AES_BLOCK_LEN] = {0x69, 0xc4, 0xe0, 0xd8, 0x6a, 0x7b, 0x04, 0x30,
                                                         0xd8, 0xcd, 0xb7, 0x80, 0x70, 0xb4, 0xc5, 0x5a};
    struct tsr_cipher cipher;
    workbench_expect(tsr_cipher_init(&cipher, workbench_aes, key) == TSR_OK, "cipher init");
    workbench_begin();
    enum tsr_status status = cipher.ops->encrypt(&cipher.key, block, block);
    workbench_end("aes_block", TSR_AES_BLOCK_LEN);
    workbench_expect(status == TSR_OK && memcmp(block, kExpected, sizeof block) == 0, "FIPS 197, C.1");
}

static void run_pieces(struct tsr_ccm *ccm, size_t text_len)
{
    uint8_t *body = message + TSR_MESSAGE_HEADER_LEN;
    for (size_t at = 0; at < text_len; at += PIECE_LEN) {
        size_t len = text_len - at < PIECE_LEN ? text_len - at : PIECE_LEN;
        workbench_expect(tsr_ccm_update(ccm, body + at, len) == TSR_OK, "ccm update");
    }
}

static void run_message(const struct tsr_cipher *cipher, const uint8_t *text, size_t text_len)
{
    const struct tsr_message_header header = {
        .kind = TSR_MESSAGE_MAP, .key_use = TSR_KEY_NODE, .origin = 3, .destination = 0, .counter = 77};
    uint8_t *body = message + TSR_MESSAGE_HEADER_LEN;
    struct tsr_ccm ccm;
    memcpy(body, text, text_len);
    workbench_begin();
    enum tsr_status status = tsr_message_seal_start(&ccm, &header, cipher, message, sizeof message, text_len);
    workbench_expect(status == TSR_OK, "seal start");
    run_pieces(&ccm, text_len);
    status = tsr_ccm_seal(&ccm, body + text_len);
    workbench_end("seal_message", text_len);
    workbench_expect(status == TSR_OK, "seal");
    size_t message_len = text_len + TSR_MESSAGE_OVERHEAD_LEN;
    workbench_store("message.out", message, message_len);

    workbench_begin();
    workbench_expect(tsr_message_open_start(&ccm, &header, cipher, message_len) == TSR_OK, "open start");
    run_pieces(&ccm, text_len);
    status = tsr_ccm_open(&ccm, body + text_len);
    workbench_end("open_message", text_len);
    workbench_expect(status == TSR_OK && memcmp(body, text, text_len) == 0, "open");
}

static void run_frames(const struct tsr_cipher *cipher, const uint8_t *text)
{
    uint8_t psdus[FRAMES][TSR_FRAME_PSDU_MAX];
    uint8_t payload[TSR_FRAME_PAYLOAD_MAX];
    size_t len = 0;
    bool done = true;
    struct tsr_frame_header header = {
        .ack_request = true, .pan_id = PAN_ID, .destination = 2, .source = 3, .counter = 1000};
    workbench_begin();
    for (unsigned i = 0; i < FRAMES; i++) {
        header.sequence++;
        header.counter++;
        done = tsr_frame_seal(&header, cipher, text, sizeof payload, psdus[i], sizeof psdus[i], &len) == TSR_OK && done;
    }
    workbench_end("seal_frame", (size_t)FRAMES * TSR_FRAME_PSDU_MAX);
    workbench_expect(done && len == TSR_FRAME_PSDU_MAX, "frame seal");
    workbench_store("frames.out", psdus, sizeof psdus);

    workbench_begin();
    for (unsigned i = 0; i < FRAMES; i++) {
        done = tsr_frame_parse(psdus[i], sizeof psdus[i], &header) == TSR_OK &&
               tsr_frame_open(psdus[i], sizeof psdus[i], cipher, payload, sizeof payload, &len) == TSR_OK && done;
    }
    workbench_end("open_frame", (size_t)FRAMES * TSR_FRAME_PSDU_MAX);
    workbench_expect(done && memcmp(payload, text, sizeof payload) == 0, "frame open");
}

void workbench_run_seals(const uint8_t *text, size_t text_len)
{
    uint8_t key[TSR_AES_KEY_LEN];
    memset(key, 0xc0, sizeof key);
    struct tsr_cipher cipher;
    run_block();
    workbench_expect(text_len >= TSR_FRAME_PAYLOAD_MAX && text_len <= TEXT_MAX, "text length");
    workbench_expect(tsr_cipher_init(&cipher, workbench_aes, key) == TSR_OK, "cipher init");
    run_message(&cipher, text, text_len);
    run_frames(&cipher, text);
}

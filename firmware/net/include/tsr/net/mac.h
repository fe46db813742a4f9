/*
 * MAC: unslotted CSMA/CA, retries, frame security and replay rejection.
 *
 *              send()                  timer                    TX_DONE
 *     IDLE ─────────────► BACKOFF ────────────► TRANSMITTING ──┬─────────► IDLE
 *                            ▲      busy: NB+1, BE+1           │ acked: confirm OK
 *                            ├─────────────────────────────────┤
 *                            └─────────────────────────────────┘ no ack: next retry
 *
 * IEEE 802.15.4-2015, 6.2.5.1 (CSMA-CA), 6.7.4.3 (retransmission). The radio
 * acknowledges (tsr/hal/radio.h).
 *
 * Nothing is acknowledged that cannot be kept: while the receive ring is full
 * the radio does not listen, so senders hold their frames and try again.
 *
 * Two contexts share a MAC. Interrupt context: tsr_mac_on_radio and
 * tsr_mac_on_timer. Task context: tsr_mac_send, tsr_mac_received,
 * tsr_mac_release, tsr_mac_confirmed. They meet only in rings with one writer
 * and one reader each, so that neither waits for the other. After tsr_mac_send
 * and tsr_mac_release, call tsr_mac_on_timer in the interrupt context.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_NET_MAC_H
#define TSR_NET_MAC_H

#include <stdbool.h>
#include <stdint.h>

#include "tsr/hal/entropy.h"
#include "tsr/hal/radio.h"
#include "tsr/wire/frame.h"

#define TSR_MAC_QUEUE_LEN 8u /* frames each way; a power of two */
#define TSR_MAC_NEIGHBOURS_MAX 16u
#define TSR_TIME_NEVER UINT64_MAX

/* IEEE 802.15.4-2015, Table 8-94, defaults. */
#define TSR_MAC_MIN_BE 3u                                   /* macMinBe */
#define TSR_MAC_MAX_BE 5u                                   /* macMaxBe */
#define TSR_MAC_MAX_CSMA_BACKOFFS 4u                        /* macMaxCsmaBackoffs */
#define TSR_MAC_MAX_FRAME_RETRIES 3u                        /* macMaxFrameRetries */
#define TSR_MAC_UNIT_BACKOFF_US (20u * TSR_RADIO_SYMBOL_US) /* aUnitBackoffPeriod */

struct tsr_mac_config {
    uint16_t pan_id;
    uint16_t address;
    uint8_t channel;        /* 11..26 */
    uint32_t counter_start; /* above every frame counter used under this link key by this address */
};

struct tsr_mac_frame {
    uint64_t time_us; /* end of the frame on air; received frames only */
    uint16_t peer;    /* destination to send to, source of a received one */
    uint16_t token;   /* sender's own mark, given back in the confirm */
    bool once;        /* send: no retry after a missing acknowledgement */
    int8_t rssi_dbm;
    uint8_t len;
    uint8_t payload[TSR_FRAME_PAYLOAD_MAX];
};

struct tsr_mac_confirm {
    uint64_t time_us; /* end of the transmission that was acknowledged */
    uint16_t token;
    enum tsr_status status; /* TSR_OK; TSR_ERR_TIMEOUT: no ack; TSR_ERR_BUSY: channel never clear or radio
                               refused; TSR_ERR_ARG: frame counters used up; what the cipher returned */
};

struct tsr_mac_neighbour {
    uint16_t address;
    uint32_t last_counter;
};

/* Every frame ends in exactly one of these. */
struct tsr_mac_counters {
    uint32_t sent;           /* acknowledged */
    uint32_t unacknowledged; /* gave up after the retries */
    uint32_t channel_busy;   /* gave up in CSMA, or the radio refused to send */
    uint32_t unsealed;       /* frame counters used up, or the cipher failed */
    uint32_t retries;
    uint32_t received;          /* handed up */
    uint32_t dropped_format;    /* not a frame of ours, or for somebody else */
    uint32_t dropped_auth;      /* wrong MIC */
    uint32_t dropped_replay;    /* old counter; repetitions after a lost ack count here */
    uint32_t dropped_queue;     /* receive ring full: at most one frame before the radio stops listening */
    uint32_t dropped_neighbour; /* neighbour table full */
};

struct tsr_mac_ring {
    uint32_t head; /* written by the reader, with __atomic built-ins: C++ reads this header too */
    uint32_t tail; /* written by the writer */
};

/* Content private to the module; 2.4 KB on a 32-bit machine. */
struct tsr_mac {
    struct tsr_mac_config config;
    const struct tsr_cipher *link_cipher;
    struct tsr_radio radio;
    struct tsr_entropy entropy;
    struct tsr_mac_counters counters;
    struct tsr_mac_neighbour neighbours[TSR_MAC_NEIGHBOURS_MAX];
    uint8_t neighbour_count;
    uint8_t state;
    uint8_t backoffs; /* NB */
    uint8_t exponent; /* BE */
    uint8_t retries;
    uint8_t sequence;
    bool listening;
    uint32_t counter;
    uint64_t timer_us;
    struct tsr_mac_ring outgoing;
    struct tsr_mac_ring incoming;
    struct tsr_mac_ring confirms;
    struct tsr_mac_frame outgoing_frames[TSR_MAC_QUEUE_LEN];
    struct tsr_mac_frame incoming_frames[TSR_MAC_QUEUE_LEN];
    struct tsr_mac_confirm confirm_slots[TSR_MAC_QUEUE_LEN];
    uint8_t psdu[TSR_FRAME_PSDU_MAX];
    uint8_t psdu_len;
};

/*
 * Configure the radio and begin to receive. link_cipher and the instances
 * behind radio and entropy are kept. Returns what the radio returns, or
 * TSR_ERR_ARG for an address or channel out of range.
 */
enum tsr_status tsr_mac_init(struct tsr_mac *mac, const struct tsr_mac_config *config,
                             const struct tsr_cipher *link_cipher, struct tsr_radio radio, struct tsr_entropy entropy);

/* Task context -------------------------------------------------------------- */

/* Frames that tsr_mac_send would take now: those in the MAC and those whose
 * confirm was not taken yet are TSR_MAC_QUEUE_LEN at most. */
unsigned tsr_mac_room(const struct tsr_mac *mac);

/* Queue a payload for peer; its confirm comes later with the same token.
 * TSR_ERR_NOBUF: the ring is full; TSR_ERR_ARG: len. */
enum tsr_status tsr_mac_send(struct tsr_mac *mac, uint16_t peer, const uint8_t *payload, size_t len, uint16_t token,
                             bool once);

/* The oldest received frame, loaned until tsr_mac_release; NULL if none. */
const struct tsr_mac_frame *tsr_mac_received(const struct tsr_mac *mac);
void tsr_mac_release(struct tsr_mac *mac);

/* Take the oldest confirm; false if none. */
bool tsr_mac_confirmed(struct tsr_mac *mac, struct tsr_mac_confirm *confirm);

/* Interrupt context --------------------------------------------------------- */

void tsr_mac_on_radio(struct tsr_mac *mac, const struct tsr_radio_event *event, uint64_t now_us);
void tsr_mac_on_timer(struct tsr_mac *mac, uint64_t now_us);
/* When tsr_mac_on_timer wants to be called; TSR_TIME_NEVER if not. */
uint64_t tsr_mac_timer_us(const struct tsr_mac *mac);

#endif

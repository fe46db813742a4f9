/*
 * Sender: carries one message to its destination, with selective repeat.
 *
 *            start             last fragment, with poll        STATUS committed
 *     IDLE ────────► SENDING ─────────────────────────► POLLED ───────────────► IDLE
 *                       ▲   STATUS missing: those again   │    result TSR_OK
 *                       ├─────────────────────────────────┤
 *                       └── no STATUS in time: poll again ┘
 *
 * One fragment is in the MAC at a time. A fragment the next hop did not
 * acknowledge stays pending; what a relay lost later comes back in a STATUS.
 * Waiting grows from TSR_SENDER_WAIT_MIN_US by doubling; after
 * TSR_SENDER_TRIES_MAX waits without any progress, or as many answers that miss
 * no less than the one before, the message is given up.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_NET_SENDER_H
#define TSR_NET_SENDER_H

#include "tsr/net/mac.h"
#include "tsr/net/route.h"
#include "tsr/wire/body.h"

/* Four hops up and down at about 7 ms a hop and a queue of eight at each. */
#define TSR_SENDER_WAIT_MIN_US 500000u
#define TSR_SENDER_WAIT_MAX_US 8000000u
#define TSR_SENDER_HOP_WAIT_US 20000u /* after the next hop did not answer */
#define TSR_SENDER_TRIES_MAX 12u

struct tsr_sender_counters {
    uint32_t fragments;       /* given to the MAC, repetitions included */
    uint32_t fragments_again; /* of these, asked for again or not acknowledged */
    uint32_t polls;           /* repeated after no STATUS */
};

/* Content private to the module. */
struct tsr_sender {
    const uint8_t *message;
    size_t message_len;
    uint16_t origin;
    uint16_t destination;
    uint16_t message_id;
    uint16_t token;
    uint16_t count;
    uint16_t pending_count;
    uint16_t next;
    uint16_t in_mac; /* fragment index */
    uint8_t state;
    uint8_t tries;
    uint8_t idle_rounds;    /* answers in a row that missed as much as the one before */
    uint16_t missing_first; /* of the last answer */
    uint16_t missing_count;
    bool mac_busy;
    enum tsr_status result;
    uint64_t timer_us;
    struct tsr_sender_counters counters;
    uint8_t pending[TSR_FRAGMENT_COUNT_MAX / 8];
};

/* Idle, for an origin. token marks its frames among the MAC's confirms. */
void tsr_sender_init(struct tsr_sender *sender, uint16_t origin, uint16_t token);

/* Begin to send a sealed message, kept until the sender is idle again.
 * TSR_ERR_BUSY while it is not; TSR_ERR_SIZE: empty or too long. */
enum tsr_status tsr_sender_start(struct tsr_sender *sender, const uint8_t *message, size_t message_len,
                                 uint16_t destination, uint32_t message_counter, uint64_t now_us);

/* Give the MAC its next fragment if it is time. */
void tsr_sender_step(struct tsr_sender *sender, struct tsr_mac *mac, const struct tsr_routes *routes, uint64_t now_us);

/* Forget the message: its buffer is the caller's again at once. */
void tsr_sender_abort(struct tsr_sender *sender);

/* A confirm that carries the sender's token. */
void tsr_sender_on_confirm(struct tsr_sender *sender, const struct tsr_mac_confirm *confirm, uint64_t now_us);

/* An authentic STATUS from the message's destination; one for another message
 * is ignored. */
void tsr_sender_on_status(struct tsr_sender *sender, const struct tsr_body_status *status, uint64_t now_us);

bool tsr_sender_is_idle(const struct tsr_sender *sender);
/* How the last message ended: TSR_OK committed, TSR_ERR_TIMEOUT given up,
 * TSR_ERR_FORMAT refused by its destination, TSR_ERR_NOROUTE, TSR_ERR_BUSY
 * aborted. */
enum tsr_status tsr_sender_result(const struct tsr_sender *sender);
/* When tsr_sender_step wants to be called; TSR_TIME_NEVER if on an event only. */
uint64_t tsr_sender_timer_us(const struct tsr_sender *sender);

#endif

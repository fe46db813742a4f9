/*
 * A loop-back in place of a radio: the board has none.
 *
 * Nodes that run on one board hear each other through memory. It keeps the
 * contract of tsr/hal/radio.h and the durations of its symbols, so that the MAC
 * and everything above it runs as on air. It is no model of a channel:
 *
 *   has        address and PAN filter, channel number, acknowledgement, receiver off
 *   has not    loss, collisions, clear-channel assessment, range, RSSI (always 0 dBm)
 *
 * The owner calls tsr_mps2_loopback_poll in place of a radio interrupt; a frame
 * and the answer to its sender are delivered together, when the acknowledgement ends.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_MPS2_LOOPBACK_H
#define TSR_HAL_MPS2_LOOPBACK_H

#include "tsr/hal/radio.h"

#define TSR_MPS2_LOOPBACK_RADIOS_MAX 4u

typedef void (*tsr_mps2_radio_handler)(void *owner, const struct tsr_radio_event *event, uint64_t now_us);

struct tsr_mps2_loopback;

/* Content belongs to the module. */
struct tsr_mps2_radio {
    struct tsr_mps2_loopback *loopback;
    tsr_mps2_radio_handler handler;
    void *owner;
    const uint8_t *psdu; /* NULL: not transmitting */
    uint64_t frame_end_us;
    uint64_t done_us; /* acknowledgement at its end */
    uint16_t pan_id;
    uint16_t address;
    uint8_t psdu_len;
    uint8_t channel;
    bool receiving;
};

struct tsr_mps2_loopback {
    uint64_t (*now_us)(void);
    struct tsr_mps2_radio radios[TSR_MPS2_LOOPBACK_RADIOS_MAX];
    unsigned radio_count;
    uint32_t frames; /* acknowledged or not */
};

void tsr_mps2_loopback_init(struct tsr_mps2_loopback *loopback, uint64_t (*now_us)(void));

/* One more radio; owner is kept and given to handler. TSR_ERR_NOBUF: too many. */
enum tsr_status tsr_mps2_loopback_add(struct tsr_mps2_loopback *loopback, tsr_mps2_radio_handler handler, void *owner,
                                      struct tsr_radio *radio);

/* Deliver what has ended by now. */
void tsr_mps2_loopback_poll(struct tsr_mps2_loopback *loopback);

/* When something ends next; UINT64_MAX if nothing is on air. */
uint64_t tsr_mps2_loopback_timer_us(const struct tsr_mps2_loopback *loopback);

#endif

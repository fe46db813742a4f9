/*
 * A radio and an entropy source for tests of the MAC and the nodes: every call
 * is recorded and answered as the test says.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TEST_FAKE_RADIO_H
#define TSR_TEST_FAKE_RADIO_H

#include <string.h>

#include "tsr/hal/entropy.h"
#include "tsr/hal/radio.h"
#include "tsr/wire/frame.h"

struct fake_radio {
    unsigned configured;
    unsigned transmits; /* calls, refused ones included */
    unsigned receiving_calls;
    bool receiving;
    bool busy;                    /* a transmission waits for its TX_DONE */
    enum tsr_status on_configure; /* what the calls return */
    enum tsr_status on_receiving;
    enum tsr_status on_transmit;
    const uint8_t *sent; /* kept until TX_DONE */
    size_t sent_len;
    uint8_t sent_copy[TSR_FRAME_PSDU_MAX];
};

static inline enum tsr_status fake_radio_configure(void *self, uint8_t channel, uint16_t pan_id, uint16_t address)
{
    struct fake_radio *radio = (struct fake_radio *)self;
    (void)channel;
    (void)pan_id;
    (void)address;
    radio->configured++;
    return radio->on_configure;
}

static inline enum tsr_status fake_radio_set_receiving(void *self, bool receiving)
{
    struct fake_radio *radio = (struct fake_radio *)self;
    radio->receiving_calls++;
    radio->receiving = receiving;
    return radio->on_receiving;
}

static inline enum tsr_status fake_radio_transmit(void *self, const uint8_t *psdu, size_t psdu_len)
{
    struct fake_radio *radio = (struct fake_radio *)self;
    radio->transmits++;
    if (radio->busy) {
        return TSR_ERR_BUSY;
    }
    if (psdu_len > TSR_FRAME_PSDU_MAX) {
        return TSR_ERR_ARG;
    }
    if (radio->on_transmit == TSR_OK) {
        radio->busy = true;
        radio->sent = psdu;
        radio->sent_len = psdu_len;
        memcpy(radio->sent_copy, psdu, psdu_len);
    }
    return radio->on_transmit;
}

static const struct tsr_radio_ops fake_radio_ops = {fake_radio_configure, fake_radio_set_receiving,
                                                    fake_radio_transmit};

static inline struct tsr_radio fake_radio_of(struct fake_radio *self)
{
    struct tsr_radio radio = {&fake_radio_ops, self};
    return radio;
}

/* Whether the bytes the MAC promised to keep are still those it gave. */
static inline bool fake_radio_psdu_kept(const struct fake_radio *radio)
{
    return memcmp(radio->sent, radio->sent_copy, radio->sent_len) == 0;
}

/* The event that ends the transmission under way. */
static inline struct tsr_radio_event fake_radio_done(struct fake_radio *radio, enum tsr_radio_outcome outcome,
                                                     uint64_t time_us)
{
    struct tsr_radio_event event;
    memset(&event, 0, sizeof event);
    event.kind = TSR_RADIO_TX_DONE;
    event.time_us = time_us;
    event.outcome = outcome;
    radio->busy = false;
    return event;
}

static inline struct tsr_radio_event fake_radio_heard(const uint8_t *psdu, size_t psdu_len, uint64_t time_us)
{
    struct tsr_radio_event event;
    memset(&event, 0, sizeof event);
    event.kind = TSR_RADIO_RECEIVED;
    event.time_us = time_us;
    event.received.psdu = psdu;
    event.received.psdu_len = (uint8_t)psdu_len;
    event.received.rssi_dbm = -60;
    return event;
}

struct fake_entropy {
    uint8_t value;   /* the first byte given */
    uint8_t step;    /* from byte to byte; 0: all the same */
    unsigned filled; /* bytes */
};

static inline void fake_entropy_fill(void *self, uint8_t *bytes, size_t len)
{
    struct fake_entropy *entropy = (struct fake_entropy *)self;
    for (size_t i = 0; i < len; i++) {
        bytes[i] = entropy->value;
        entropy->value = (uint8_t)(entropy->value + entropy->step);
        entropy->filled++;
    }
}

static const struct tsr_entropy_ops fake_entropy_ops = {fake_entropy_fill};

static inline struct tsr_entropy fake_entropy_of(struct fake_entropy *self)
{
    struct tsr_entropy entropy = {&fake_entropy_ops, self};
    return entropy;
}

#endif

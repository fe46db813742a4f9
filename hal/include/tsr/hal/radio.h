/*
 * Radio: an IEEE 802.15.4 transceiver at 250 kbit/s, 2.4 GHz O-QPSK.
 *
 *            set_receiving(true)            transmit()
 *     SLEEP ────────────────────► RECEIVE ────────────► CCA ──clear──► TRANSMIT
 *       ▲    set_receiving(false)   │  ▲                 │ busy          │
 *       └───────────────────────────┘  │ ◄───────────────┘               │
 *                                      └──── TX_DONE ◄──── wait for ack ─┘
 *
 * What must happen within microseconds belongs to the radio, not to the MAC:
 * it filters frames by PAN and address, acknowledges them itself after
 * aTurnaroundTime (12 symbols), and waits for the acknowledgement of its own
 * frames. transmit() senses the channel for 8 symbols (IEEE 802.15.4-2015,
 * 10.2.8) first. Back-off and retries are the MAC's.
 *
 * No call blocks: transmit() is answered by exactly one TX_DONE event. Events
 * come by the function that the owner of radio and node connects, possibly
 * from an interrupt.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_RADIO_H
#define TSR_HAL_RADIO_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "tsr/base/status.h"

/* IEEE 802.15.4-2015, 12.1.1: 62.5 ksymbol/s, 16 us a symbol. */
#define TSR_RADIO_SYMBOL_US 16u
#define TSR_RADIO_OCTET_US 32u
#define TSR_RADIO_TURNAROUND_US (12u * TSR_RADIO_SYMBOL_US) /* aTurnaroundTime, Table 11-1 */
#define TSR_RADIO_CCA_US (8u * TSR_RADIO_SYMBOL_US)         /* aCcaTime, Table 11-1 */
#define TSR_RADIO_PHY_HEADER_OCTETS 6u                      /* preamble 4, SFD 1, length 1 */
#define TSR_RADIO_ACK_WAIT_US (54u * TSR_RADIO_SYMBOL_US)   /* macAckWaitDuration, Table 8-94, 2.4 GHz */

enum tsr_radio_outcome {
    TSR_RADIO_SENT, /* no acknowledgement was asked for */
    TSR_RADIO_ACKED,
    TSR_RADIO_NO_ACK,
    TSR_RADIO_CHANNEL_BUSY, /* nothing was sent */
    TSR_RADIO_FAULT         /* the device failed */
};

enum tsr_radio_event_kind {
    TSR_RADIO_RECEIVED,
    TSR_RADIO_TX_DONE
};

struct tsr_radio_received {
    const uint8_t *psdu; /* borrowed */
    uint8_t psdu_len;    /* with FCS, not more than 127 */
    int8_t rssi_dbm;
};

struct tsr_radio_event {
    enum tsr_radio_event_kind kind;
    /* End of the frame (its last octet) on air, received or sent: the same
     * instant at both ends but for the flight time. */
    uint64_t time_us;
    union {
        struct tsr_radio_received received;
        enum tsr_radio_outcome outcome;
    };
};

struct tsr_radio_ops {
    /* Set channel (11..26) and frame filter. TSR_ERR_ARG, TSR_ERR_IO. */
    enum tsr_status (*configure)(void *radio, uint8_t channel, uint16_t pan_id, uint16_t address);
    /* Receive or sleep when not transmitting. */
    enum tsr_status (*set_receiving)(void *radio, bool receiving);
    /* Sense, then send psdu[psdu_len] (with FCS), which is kept until TX_DONE.
     * TSR_ERR_BUSY while an earlier one is unanswered; TSR_ERR_ARG for a length of 0 or over 127. */
    enum tsr_status (*transmit)(void *radio, const uint8_t *psdu, size_t psdu_len);
};

struct tsr_radio {
    const struct tsr_radio_ops *ops;
    void *self;
};

#endif

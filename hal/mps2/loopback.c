/*
 * Loop-back radio.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/hal/mps2_loopback.h"

#include <string.h>

#define PSDU_MAX 127u
#define CHANNEL_MIN 11u
#define CHANNEL_MAX 26u
#define BROADCAST 0xffffu
#define ACK_OCTETS 5u

/* MAC header, IEEE 802.15.4-2015, 7.2: acknowledgement request, PAN and short destination address. */
#define FCF_ACK_REQUEST 0x20u
#define PAN_AT 3u
#define DESTINATION_AT 5u
#define HEADER_LEN 7u

static uint16_t read_u16(const uint8_t *bytes)
{
    return (uint16_t)(bytes[0] | bytes[1] << 8);
}

static uint32_t duration_us(size_t octets)
{
    return (uint32_t)(TSR_RADIO_PHY_HEADER_OCTETS + octets) * TSR_RADIO_OCTET_US;
}

static enum tsr_status configure(void *self, uint8_t channel, uint16_t pan_id, uint16_t address)
{
    struct tsr_mps2_radio *radio = self;
    if (channel < CHANNEL_MIN || channel > CHANNEL_MAX) {
        return TSR_ERR_ARG;
    }
    radio->channel = channel;
    radio->pan_id = pan_id;
    radio->address = address;
    return TSR_OK;
}

static enum tsr_status set_receiving(void *self, bool receiving)
{
    struct tsr_mps2_radio *radio = self;
    radio->receiving = receiving;
    return TSR_OK;
}

static enum tsr_status transmit(void *self, const uint8_t *psdu, size_t psdu_len)
{
    struct tsr_mps2_radio *radio = self;
    if (psdu_len < HEADER_LEN || psdu_len > PSDU_MAX) {
        return TSR_ERR_ARG;
    }
    if (radio->psdu != NULL) {
        return TSR_ERR_BUSY;
    }
    uint64_t start_us = radio->loopback->now_us() + TSR_RADIO_CCA_US + TSR_RADIO_TURNAROUND_US;
    radio->psdu = psdu;
    radio->psdu_len = (uint8_t)psdu_len;
    radio->frame_end_us = start_us + duration_us(psdu_len);
    bool wants_ack = (psdu[0] & FCF_ACK_REQUEST) != 0;
    radio->done_us = radio->frame_end_us + (wants_ack ? TSR_RADIO_TURNAROUND_US + duration_us(ACK_OCTETS) : 0);
    return TSR_OK;
}

static const struct tsr_radio_ops kOps = {configure, set_receiving, transmit};

void tsr_mps2_loopback_init(struct tsr_mps2_loopback *loopback, uint64_t (*now_us)(void))
{
    memset(loopback, 0, sizeof *loopback);
    loopback->now_us = now_us;
}

enum tsr_status tsr_mps2_loopback_add(struct tsr_mps2_loopback *loopback, tsr_mps2_radio_handler handler, void *owner,
                                      struct tsr_radio *radio)
{
    if (loopback->radio_count == TSR_MPS2_LOOPBACK_RADIOS_MAX) {
        return TSR_ERR_NOBUF;
    }
    struct tsr_mps2_radio *self = &loopback->radios[loopback->radio_count++];
    self->loopback = loopback;
    self->handler = handler;
    self->owner = owner;
    radio->ops = &kOps;
    radio->self = self;
    return TSR_OK;
}

static bool hears(const struct tsr_mps2_radio *receiver, const struct tsr_mps2_radio *sender)
{
    uint16_t destination = read_u16(sender->psdu + DESTINATION_AT);
    return receiver != sender && receiver->receiving && receiver->channel == sender->channel &&
           receiver->pan_id == read_u16(sender->psdu + PAN_AT) &&
           (destination == BROADCAST || destination == receiver->address);
}

/* Hand the frame to whoever hears it; then its sender may use the radio again. */
static void finish(struct tsr_mps2_radio *sender, uint64_t now_us)
{
    struct tsr_mps2_loopback *loopback = sender->loopback;
    struct tsr_radio_event received = {.kind = TSR_RADIO_RECEIVED, .time_us = sender->frame_end_us};
    received.received.psdu = sender->psdu;
    received.received.psdu_len = sender->psdu_len;
    bool wants_ack = (sender->psdu[0] & FCF_ACK_REQUEST) != 0;
    bool heard = false;
    for (unsigned i = 0; i < loopback->radio_count; i++) {
        struct tsr_mps2_radio *receiver = &loopback->radios[i];
        if (hears(receiver, sender)) {
            heard = true;
            receiver->handler(receiver->owner, &received, now_us);
        }
    }
    loopback->frames++;
    sender->psdu = NULL;
    struct tsr_radio_event done = {.kind = TSR_RADIO_TX_DONE, .time_us = sender->frame_end_us};
    done.outcome = !wants_ack ? TSR_RADIO_SENT : heard ? TSR_RADIO_ACKED : TSR_RADIO_NO_ACK;
    sender->handler(sender->owner, &done, now_us);
}

void tsr_mps2_loopback_poll(struct tsr_mps2_loopback *loopback)
{
    uint64_t now_us = loopback->now_us();
    for (unsigned i = 0; i < loopback->radio_count; i++) {
        struct tsr_mps2_radio *radio = &loopback->radios[i];
        if (radio->psdu != NULL && radio->done_us <= now_us) {
            finish(radio, now_us);
        }
    }
}

uint64_t tsr_mps2_loopback_timer_us(const struct tsr_mps2_loopback *loopback)
{
    uint64_t timer_us = UINT64_MAX;
    for (unsigned i = 0; i < loopback->radio_count; i++) {
        const struct tsr_mps2_radio *radio = &loopback->radios[i];
        if (radio->psdu != NULL && radio->done_us < timer_us) {
            timer_us = radio->done_us;
        }
    }
    return timer_us;
}

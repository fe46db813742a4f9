/*
 * MAC: CSMA/CA, retries, frame security, replay rejection.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/net/mac.h"

#include <string.h>

#include "tsr/wire/address.h"

enum state {
    IDLE,
    BACKOFF,
    TRANSMITTING
};

_Static_assert((TSR_MAC_QUEUE_LEN & (TSR_MAC_QUEUE_LEN - 1u)) == 0, "ring indices wrap by masking");

/* Rings: head and tail run freely, their difference is the fill. */
static uint32_t ring_count(const struct tsr_mac_ring *ring)
{
    return __atomic_load_n(&ring->tail, __ATOMIC_ACQUIRE) - __atomic_load_n(&ring->head, __ATOMIC_ACQUIRE);
}

static uint32_t ring_head(const struct tsr_mac_ring *ring)
{
    return __atomic_load_n(&ring->head, __ATOMIC_RELAXED) & (TSR_MAC_QUEUE_LEN - 1u);
}

static uint32_t ring_tail(const struct tsr_mac_ring *ring)
{
    return __atomic_load_n(&ring->tail, __ATOMIC_RELAXED) & (TSR_MAC_QUEUE_LEN - 1u);
}

static void ring_pop(struct tsr_mac_ring *ring)
{
    __atomic_store_n(&ring->head, ring->head + 1u, __ATOMIC_RELEASE);
}

static void ring_push(struct tsr_mac_ring *ring)
{
    __atomic_store_n(&ring->tail, ring->tail + 1u, __ATOMIC_RELEASE);
}

enum tsr_status tsr_mac_init(struct tsr_mac *mac, const struct tsr_mac_config *config,
                             const struct tsr_cipher *link_cipher, struct tsr_radio radio, struct tsr_entropy entropy)
{
    if (config->address < TSR_ADDRESS_NODE_MIN || config->address > TSR_ADDRESS_NODE_MAX || config->channel < 11 ||
        config->channel > 26) {
        return TSR_ERR_ARG;
    }
    memset(mac, 0, sizeof *mac);
    mac->config = *config;
    mac->link_cipher = link_cipher;
    mac->radio = radio;
    mac->entropy = entropy;
    mac->counter = config->counter_start;
    mac->timer_us = TSR_TIME_NEVER;
    enum tsr_status status = radio.ops->configure(radio.self, config->channel, config->pan_id, config->address);
    mac->listening = true;
    return status == TSR_OK ? radio.ops->set_receiving(radio.self, true) : status;
}

/* A frame holds its place until its confirm is taken, so that no confirm can
 * find its ring full. The interrupt moves frames from outgoing to confirms:
 * counted in this order one may count twice, none is missed. */
unsigned tsr_mac_room(const struct tsr_mac *mac)
{
    uint32_t held = ring_count(&mac->outgoing);
    held += ring_count(&mac->confirms);
    return held < TSR_MAC_QUEUE_LEN ? TSR_MAC_QUEUE_LEN - held : 0;
}

enum tsr_status tsr_mac_send(struct tsr_mac *mac, uint16_t peer, const uint8_t *payload, size_t len, uint16_t token,
                             bool once)
{
    if (len == 0 || len > TSR_FRAME_PAYLOAD_MAX) {
        return TSR_ERR_ARG;
    }
    if (tsr_mac_room(mac) == 0) {
        return TSR_ERR_NOBUF;
    }
    struct tsr_mac_frame *frame = &mac->outgoing_frames[ring_tail(&mac->outgoing)];
    frame->peer = peer;
    frame->token = token;
    frame->once = once;
    frame->len = (uint8_t)len;
    memcpy(frame->payload, payload, len);
    ring_push(&mac->outgoing);
    return TSR_OK;
}

const struct tsr_mac_frame *tsr_mac_received(const struct tsr_mac *mac)
{
    return ring_count(&mac->incoming) > 0 ? &mac->incoming_frames[ring_head(&mac->incoming)] : NULL;
}

void tsr_mac_release(struct tsr_mac *mac)
{
    if (ring_count(&mac->incoming) > 0) {
        ring_pop(&mac->incoming);
    }
}

bool tsr_mac_confirmed(struct tsr_mac *mac, struct tsr_mac_confirm *confirm)
{
    if (ring_count(&mac->confirms) == 0) {
        return false;
    }
    *confirm = mac->confirm_slots[ring_head(&mac->confirms)];
    ring_pop(&mac->confirms);
    return true;
}

uint64_t tsr_mac_timer_us(const struct tsr_mac *mac)
{
    return mac->timer_us;
}

/* A random number of unit backoff periods, 0 .. 2^BE - 1. */
static void start_backoff(struct tsr_mac *mac, uint64_t now_us)
{
    uint8_t random;
    mac->entropy.ops->fill(mac->entropy.self, &random, 1);
    uint32_t periods = random & ((1u << mac->exponent) - 1u);
    mac->state = BACKOFF;
    mac->timer_us = now_us + (uint64_t)periods * TSR_MAC_UNIT_BACKOFF_US;
}

static void begin_attempt(struct tsr_mac *mac, uint64_t now_us)
{
    mac->backoffs = 0;
    mac->exponent = TSR_MAC_MIN_BE;
    start_backoff(mac, now_us);
}

/* Report the frame at the head and go on with the next. */
static void finish_frame(struct tsr_mac *mac, enum tsr_status status, uint64_t time_us)
{
    /* tsr_mac_room has kept a slot for it. */
    struct tsr_mac_confirm *confirm = &mac->confirm_slots[ring_tail(&mac->confirms)];
    confirm->token = mac->outgoing_frames[ring_head(&mac->outgoing)].token;
    confirm->status = status;
    confirm->time_us = time_us;
    ring_push(&mac->confirms);
    ring_pop(&mac->outgoing);
    mac->state = IDLE;
    mac->timer_us = TSR_TIME_NEVER;
}

/* Take the next frame from the ring: seal it once, under a fresh counter; its
 * retries repeat the same bytes. */
static void begin_next(struct tsr_mac *mac, uint64_t now_us)
{
    while (mac->state == IDLE && ring_count(&mac->outgoing) > 0) {
        const struct tsr_mac_frame *frame = &mac->outgoing_frames[ring_head(&mac->outgoing)];
        const struct tsr_frame_header header = {
            .sequence = mac->sequence++,
            .ack_request = frame->peer != TSR_ADDRESS_BROADCAST,
            .pan_id = mac->config.pan_id,
            .destination = frame->peer,
            .source = mac->config.address,
            .counter = mac->counter,
        };
        if (mac->counter != UINT32_MAX) { /* worn out: sealing refuses it, and it must not wrap */
            mac->counter++;
        }
        size_t len = 0;
        enum tsr_status status =
            tsr_frame_seal(&header, mac->link_cipher, frame->payload, frame->len, mac->psdu, sizeof mac->psdu, &len);
        if (status != TSR_OK) {
            mac->counters.unsealed++;
            finish_frame(mac, status, now_us);
            continue;
        }
        mac->psdu_len = (uint8_t)len;
        mac->retries = 0;
        begin_attempt(mac, now_us);
    }
}

/* Listen only while another frame can be kept. */
static void update_listening(struct tsr_mac *mac)
{
    bool listening = ring_count(&mac->incoming) < TSR_MAC_QUEUE_LEN;
    if (listening != mac->listening) {
        mac->listening = listening;
        mac->radio.ops->set_receiving(mac->radio.self, listening);
    }
}

/* The channel is not clear: back off longer, or give the frame up. */
static void on_busy(struct tsr_mac *mac, uint64_t time_us, uint64_t now_us)
{
    if (mac->backoffs < TSR_MAC_MAX_CSMA_BACKOFFS) {
        mac->backoffs++;
        mac->exponent = mac->exponent < TSR_MAC_MAX_BE ? (uint8_t)(mac->exponent + 1u) : mac->exponent;
        start_backoff(mac, now_us);
    } else {
        mac->counters.channel_busy++;
        finish_frame(mac, TSR_ERR_BUSY, time_us);
    }
}

void tsr_mac_on_timer(struct tsr_mac *mac, uint64_t now_us)
{
    update_listening(mac);
    begin_next(mac, now_us);
    if (mac->state == BACKOFF && now_us >= mac->timer_us) {
        if (mac->radio.ops->transmit(mac->radio.self, mac->psdu, mac->psdu_len) == TSR_OK) {
            mac->state = TRANSMITTING;
            mac->timer_us = TSR_TIME_NEVER;
        } else { /* a device that refuses for good must not hold the frame for good */
            on_busy(mac, now_us, now_us + TSR_MAC_UNIT_BACKOFF_US);
            begin_next(mac, now_us);
        }
    }
}

static void on_transmitted(struct tsr_mac *mac, const struct tsr_radio_event *event, uint64_t now_us)
{
    if (mac->state != TRANSMITTING) {
        return;
    }
    switch (event->outcome) {
    case TSR_RADIO_SENT:
    case TSR_RADIO_ACKED:
        mac->counters.sent++;
        finish_frame(mac, TSR_OK, event->time_us);
        break;
    case TSR_RADIO_CHANNEL_BUSY: on_busy(mac, event->time_us, now_us); break;
    case TSR_RADIO_NO_ACK:
    case TSR_RADIO_FAULT:
        if (mac->retries < TSR_MAC_MAX_FRAME_RETRIES && !mac->outgoing_frames[ring_head(&mac->outgoing)].once) {
            mac->retries++;
            mac->counters.retries++;
            begin_attempt(mac, now_us);
        } else {
            mac->counters.unacknowledged++;
            finish_frame(mac, TSR_ERR_TIMEOUT, event->time_us);
        }
        break;
    }
    begin_next(mac, now_us);
}

static struct tsr_mac_neighbour *find_neighbour(struct tsr_mac *mac, uint16_t address)
{
    for (unsigned i = 0; i < mac->neighbour_count; i++) {
        if (mac->neighbours[i].address == address) {
            return &mac->neighbours[i];
        }
    }
    return NULL;
}

/* Accept counters above the neighbour's last one (IEEE 802.15.4-2015, 9.2.3):
 * the caller has checked the MIC. */
static bool accept_counter(struct tsr_mac *mac, uint16_t source, uint32_t counter)
{
    struct tsr_mac_neighbour *neighbour = find_neighbour(mac, source);
    if (neighbour == NULL) {
        if (mac->neighbour_count == TSR_MAC_NEIGHBOURS_MAX) {
            mac->counters.dropped_neighbour++;
            return false;
        }
        neighbour = &mac->neighbours[mac->neighbour_count++];
        neighbour->address = source;
    } else if (counter <= neighbour->last_counter) {
        mac->counters.dropped_replay++;
        return false;
    }
    neighbour->last_counter = counter;
    return true;
}

static void on_received(struct tsr_mac *mac, const struct tsr_radio_event *event)
{
    struct tsr_frame_header header;
    const uint8_t *psdu = event->received.psdu;
    size_t psdu_len = event->received.psdu_len;
    if (tsr_frame_parse(psdu, psdu_len, &header) != TSR_OK || header.pan_id != mac->config.pan_id ||
        (header.destination != mac->config.address && header.destination != TSR_ADDRESS_BROADCAST)) {
        mac->counters.dropped_format++;
        return;
    }
    if (ring_count(&mac->incoming) == TSR_MAC_QUEUE_LEN) {
        mac->counters.dropped_queue++;
        return;
    }
    struct tsr_mac_frame *frame = &mac->incoming_frames[ring_tail(&mac->incoming)];
    size_t len = 0;
    if (tsr_frame_open(psdu, psdu_len, mac->link_cipher, frame->payload, sizeof frame->payload, &len) != TSR_OK) {
        mac->counters.dropped_auth++;
        return;
    }
    if (!accept_counter(mac, header.source, header.counter)) {
        return;
    }
    frame->len = (uint8_t)len;
    frame->peer = header.source;
    frame->rssi_dbm = event->received.rssi_dbm;
    frame->time_us = event->time_us;
    mac->counters.received++;
    ring_push(&mac->incoming);
}

void tsr_mac_on_radio(struct tsr_mac *mac, const struct tsr_radio_event *event, uint64_t now_us)
{
    if (event->kind == TSR_RADIO_RECEIVED) {
        on_received(mac, event);
        update_listening(mac);
    } else {
        on_transmitted(mac, event, now_us);
    }
}

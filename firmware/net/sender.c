/*
 * Selective repeat of one message.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/net/sender.h"

#include <string.h>

enum state {
    IDLE,
    SENDING,
    POLLED
};

void tsr_sender_init(struct tsr_sender *sender, uint16_t origin, uint16_t token)
{
    memset(sender, 0, sizeof *sender);
    sender->origin = origin;
    sender->token = token;
    sender->timer_us = TSR_TIME_NEVER;
}

static bool is_pending(const struct tsr_sender *sender, unsigned index)
{
    return ((unsigned)sender->pending[index >> 3] >> (index & 7u) & 1u) != 0;
}

static void set_pending(struct tsr_sender *sender, unsigned index)
{
    if (!is_pending(sender, index)) {
        sender->pending[index >> 3] = (uint8_t)(sender->pending[index >> 3] | 1u << (index & 7u));
        sender->pending_count++;
    }
}

static void clear_pending(struct tsr_sender *sender, unsigned index)
{
    if (is_pending(sender, index)) {
        sender->pending[index >> 3] = (uint8_t)(sender->pending[index >> 3] & ~(1u << (index & 7u)));
        sender->pending_count--;
    }
}

static void finish(struct tsr_sender *sender, enum tsr_status result)
{
    sender->state = IDLE;
    sender->result = result;
    sender->timer_us = TSR_TIME_NEVER;
}

enum tsr_status tsr_sender_start(struct tsr_sender *sender, const uint8_t *message, size_t message_len,
                                 uint16_t destination, uint32_t message_counter, uint64_t now_us)
{
    if (!tsr_sender_is_idle(sender)) {
        return TSR_ERR_BUSY; /* or a confirm of the last message would count for this one */
    }
    uint16_t count = tsr_fragment_count(message_len);
    if (count == 0) {
        return TSR_ERR_SIZE;
    }
    sender->message = message;
    sender->message_len = message_len;
    sender->destination = destination;
    sender->message_id = (uint16_t)message_counter;
    sender->count = count;
    sender->pending_count = 0;
    memset(sender->pending, 0, sizeof sender->pending);
    for (unsigned i = 0; i < count; i++) {
        set_pending(sender, i);
    }
    sender->next = 0;
    sender->tries = 0;
    sender->idle_rounds = 0;
    sender->missing_first = 0;
    sender->missing_count = (uint16_t)(count + 1u);
    sender->state = SENDING;
    sender->timer_us = now_us;
    return TSR_OK;
}

/* Wait for progress, longer each time. */
static void wait(struct tsr_sender *sender, uint64_t first_us, uint64_t now_us)
{
    uint64_t wait_us = first_us << sender->tries;
    sender->timer_us = now_us + (wait_us < TSR_SENDER_WAIT_MAX_US ? wait_us : TSR_SENDER_WAIT_MAX_US);
    sender->tries++;
}

void tsr_sender_step(struct tsr_sender *sender, struct tsr_mac *mac, const struct tsr_routes *routes, uint64_t now_us)
{
    if (sender->state == IDLE || sender->mac_busy || now_us < sender->timer_us || tsr_mac_room(mac) == 0) {
        return;
    }
    if (sender->tries >= TSR_SENDER_TRIES_MAX) { /* the last wait is over, too */
        finish(sender, TSR_ERR_TIMEOUT);
        return;
    }
    if (sender->state == POLLED) { /* no STATUS came: ask again with the last fragment */
        sender->counters.polls++;
        sender->state = SENDING;
        set_pending(sender, sender->count - 1u);
    }
    while (!is_pending(sender, sender->next)) {
        sender->next = (uint16_t)((sender->next + 1u) % sender->count);
    }
    struct tsr_fragment fragment = tsr_fragment_of(sender->message, sender->message_len, sender->next);
    fragment.poll = sender->pending_count == 1;
    fragment.origin = sender->origin;
    fragment.destination = sender->destination;
    fragment.message_id = sender->message_id;
    uint8_t payload[TSR_FRAME_PAYLOAD_MAX];
    size_t len = 0;
    uint16_t next_hop = tsr_route_next(routes, sender->destination);
    if (next_hop == TSR_ADDRESS_NONE || tsr_fragment_write(&fragment, payload, sizeof payload, &len) != TSR_OK ||
        tsr_mac_send(mac, next_hop, payload, len, sender->token, false) != TSR_OK) {
        finish(sender, TSR_ERR_NOROUTE);
        return;
    }
    sender->counters.fragments++;
    sender->in_mac = sender->next;
    sender->mac_busy = true;
    sender->timer_us = TSR_TIME_NEVER;
}

void tsr_sender_abort(struct tsr_sender *sender)
{
    finish(sender, TSR_ERR_BUSY);
}

void tsr_sender_on_confirm(struct tsr_sender *sender, const struct tsr_mac_confirm *confirm, uint64_t now_us)
{
    sender->mac_busy = false;
    if (sender->state != SENDING) {
        return; /* a STATUS overtook the confirm */
    }
    if (confirm->status != TSR_OK) {
        sender->counters.fragments_again++;
        wait(sender, TSR_SENDER_HOP_WAIT_US, now_us);
        return;
    }
    clear_pending(sender, sender->in_mac);
    if (sender->pending_count > 0) {
        sender->tries = 0;
        sender->timer_us = now_us;
    } else {
        sender->state = POLLED;
        wait(sender, TSR_SENDER_WAIT_MIN_US, now_us);
    }
}

/* Whether an answer misses less than the one before it did. */
static bool shows_progress(struct tsr_sender *sender, uint16_t first, uint16_t missing_count)
{
    bool progress = first > sender->missing_first || missing_count < sender->missing_count;
    sender->missing_first = first;
    sender->missing_count = missing_count;
    return progress;
}

static void send_missing(struct tsr_sender *sender, const struct tsr_body_status *status, uint64_t now_us)
{
    for (unsigned i = 0; i < 8u * status->bitmap_len; i++) {
        unsigned index = status->first + i;
        if (((unsigned)status->bitmap[i >> 3] >> (i & 7u) & 1u) != 0 && index < sender->count) {
            set_pending(sender, index);
            sender->counters.fragments_again++;
        }
    }
    if (sender->pending_count == 0) {
        return; /* it names nothing: as if no answer had come */
    }
    sender->idle_rounds =
        shows_progress(sender, status->first, sender->pending_count) ? 0 : (uint8_t)(sender->idle_rounds + 1u);
    if (sender->idle_rounds >= TSR_SENDER_TRIES_MAX) {
        finish(sender, TSR_ERR_TIMEOUT);
        return;
    }
    sender->state = SENDING;
    sender->tries = 0;
    sender->timer_us = now_us;
}

void tsr_sender_on_status(struct tsr_sender *sender, const struct tsr_body_status *status, uint64_t now_us)
{
    if (sender->state == IDLE || status->message_id != sender->message_id) {
        return;
    }
    if (status->state == TSR_DELIVERY_COMMITTED) {
        finish(sender, TSR_OK);
        return;
    }
    if (status->state == TSR_DELIVERY_REFUSED) {
        finish(sender, TSR_ERR_FORMAT);
        return;
    }
    if (sender->state == SENDING) {
        return; /* an old answer: what it misses may be on its way */
    }
    send_missing(sender, status, now_us);
}

bool tsr_sender_is_idle(const struct tsr_sender *sender)
{
    return sender->state == IDLE && !sender->mac_busy;
}

enum tsr_status tsr_sender_result(const struct tsr_sender *sender)
{
    return sender->result;
}

uint64_t tsr_sender_timer_us(const struct tsr_sender *sender)
{
    return sender->state == IDLE || sender->mac_busy ? TSR_TIME_NEVER : sender->timer_us;
}

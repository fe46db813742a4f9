/*
 * A coder of one's own in the place of matching and map coding: how the
 * emulator's baseline nodes and experiments send something else, with the same
 * watching, capturing, sealing and delivery. An image that does not call it
 * does not hold it.
 *
 *   CAPTURING ─► REFERENCE ── take_pair ─► FILTERING ── send_pair ─► SEALING ─► SENDING
 *
 * Task context. Of a binocular node without depth rules.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_NODE_SUBSTITUTE_H
#define TSR_NODE_SUBSTITUTE_H

#include "tsr/base/image.h"
#include "tsr/node/node.h"

/* Ask before each step. True when a pair has been captured: it is the caller's,
 * the views borrowed, and the node does nothing with it until it is given back by
 * tsr_node_send_pair. It goes on forwarding. */
bool tsr_node_take_pair(struct tsr_node *node, struct tsr_gray_view *left, struct tsr_gray_view *right);

/* Send what has become of the two views, as a MAP message with these two parts in the
 * place of reference image and map; copied. TSR_ERR_NOBUF: longer than the
 * longest map; TSR_ERR_ARG: no counter left. Then the capture has failed, and the next
 * frame is captured again. */
enum tsr_status tsr_node_send_pair(struct tsr_node *node, const uint8_t *left, size_t left_len, const uint8_t *right,
                                   size_t right_len, uint64_t now_us);

/* The next frame that is watched wakes, whatever it shows. */
void tsr_node_wake_next(struct tsr_node *node);

#endif

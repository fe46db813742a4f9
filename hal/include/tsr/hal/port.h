/*
 * Port: a byte stream to the sink, as a gateway has one: UART, USB or socket.
 *
 * Bytes that arrive come by the function that the owner of port and node connects.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_PORT_H
#define TSR_HAL_PORT_H

#include <stddef.h>
#include <stdint.h>

#include "tsr/base/status.h"

struct tsr_port_ops {
    /* Take all len bytes (borrowed) or none. TSR_ERR_BUSY: no room or no
     * connection now, the caller tries again later. */
    enum tsr_status (*write)(void *port, const uint8_t *bytes, size_t len);
};

struct tsr_port {
    const struct tsr_port_ops *ops;
    void *self;
};

#endif

/*
 * UART0 as a gateway's port to the sink.
 *
 * write() waits for the transmitter, byte by byte: polled, as measured 9 to 14
 * KB/s under QEMU. Received bytes are polled from a one-byte buffer; QEMU waits
 * until it is free, a real line of more than a few kbit/s would overrun it.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_MPS2_UART_H
#define TSR_HAL_MPS2_UART_H

#include <stdbool.h>
#include <stdint.h>

#include "tsr/hal/port.h"

/* Call after tsr_mps2_clock_start. */
struct tsr_port tsr_mps2_uart_start(void);

/* The next received byte; false if there is none. */
bool tsr_mps2_uart_read(uint8_t *byte);

#endif

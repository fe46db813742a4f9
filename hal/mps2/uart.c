/*
 * UART0, polled.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/hal/mps2_uart.h"

#include <stddef.h>

/* ARM Cortex-M System Design Kit (DDI 0479), 4.4: APB UART. */
struct uart {
    uint32_t data;
    uint32_t state;
    uint32_t control;
    uint32_t interrupt;
    uint32_t divisor;
};
#define UART0 ((volatile struct uart *)TSR_MPS2_UART0) /* the board's, from the build */
#define STATE_TX_FULL 1u
#define STATE_RX_FULL 2u
#define CONTROL_TX_ENABLE 1u
#define CONTROL_RX_ENABLE 2u
#define CONTROL_RX_INTERRUPT 8u
#define INTERRUPT_RX 2u
#define DIVISOR_115200 217u /* 25 MHz / 115200 */

static enum tsr_status write_port(void *port, const uint8_t *bytes, size_t len)
{
    (void)port;
    for (size_t i = 0; i < len; i++) {
        while ((UART0->state & STATE_TX_FULL) != 0) {
        }
        UART0->data = bytes[i];
    }
    return TSR_OK;
}

static const struct tsr_port_ops kOps = {write_port};

struct tsr_port tsr_mps2_uart_start(void)
{
    UART0->divisor = DIVISOR_115200;
    UART0->control = CONTROL_TX_ENABLE | CONTROL_RX_ENABLE | CONTROL_RX_INTERRUPT;
    struct tsr_port port = {&kOps, NULL};
    return port;
}

bool tsr_mps2_uart_read(uint8_t *byte)
{
    UART0->interrupt = INTERRUPT_RX;
    if ((UART0->state & STATE_RX_FULL) == 0) {
        return false;
    }
    *byte = (uint8_t)UART0->data;
    return true;
}

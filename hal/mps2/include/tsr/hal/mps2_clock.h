/*
 * Time since start, and sleep until a time or a received byte.
 *
 * CMSDK TIMER0 counts down at the 25 MHz of the board's system clock (ARM DAI
 * 0386, 3.7); its 32 bits wrap after 171 s, so that the time must be read more
 * often than that. TIMER1 ends a sleep. QEMU counts host time.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_MPS2_CLOCK_H
#define TSR_HAL_MPS2_CLOCK_H

#include <stdint.h>

void tsr_mps2_clock_start(void);
uint64_t tsr_mps2_clock_now_us(void);

/* Stop the processor until time_us, at most one minute, or until UART0 has a byte. */
void tsr_mps2_clock_sleep_until(uint64_t time_us);

#endif

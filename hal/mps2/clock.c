/*
 * Clock by two CMSDK timers.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/hal/mps2_clock.h"

/* ARM Cortex-M System Design Kit (DDI 0479), 4.3: APB timer. */
struct timer {
    uint32_t control;
    uint32_t value;
    uint32_t reload;
    uint32_t interrupt;
};
#define TIMER0 ((volatile struct timer *)0x40000000u)
#define TIMER1 ((volatile struct timer *)0x40001000u)
#define TIMER_ENABLE 1u
#define TIMER_INTERRUPT_ENABLE 8u
#define TICKS_PER_US 25u

/* ARMv7-M, B3.4.3; interrupt numbers of DAI 0386, table 3-9. */
#define NVIC_ENABLE (*(volatile uint32_t *)0xe000e100u)
#define NVIC_CLEAR_PENDING (*(volatile uint32_t *)0xe000e280u)
#define IRQ_UART0_RX (UINT32_C(1) << 0)
#define IRQ_TIMER1 (UINT32_C(1) << 9)

#define SLEEP_MIN_US 2u /* shorter is not worth the registers */
#define SLEEP_MAX_US 60000000u

static struct {
    uint64_t now_us;
    uint32_t last; /* TIMER0 at now_us */
} clock;

void tsr_mps2_clock_start(void)
{
    TIMER0->reload = UINT32_MAX;
    TIMER0->value = UINT32_MAX;
    TIMER0->control = TIMER_ENABLE;
    clock.now_us = 0;
    clock.last = UINT32_MAX;
    NVIC_ENABLE = IRQ_TIMER1 | IRQ_UART0_RX;
    /* A pending interrupt ends WFI even while masked (ARMv7-M, B1.5.19), and then needs no handler. */
    __asm volatile("cpsid i" ::: "memory");
}

uint64_t tsr_mps2_clock_now_us(void)
{
    uint32_t passed_us = (clock.last - TIMER0->value) / TICKS_PER_US;
    clock.last -= passed_us * TICKS_PER_US;
    clock.now_us += passed_us;
    return clock.now_us;
}

void tsr_mps2_clock_sleep_until(uint64_t time_us)
{
    uint64_t now_us = tsr_mps2_clock_now_us();
    if (time_us < now_us + SLEEP_MIN_US) {
        return;
    }
    uint64_t left_us = time_us - now_us;
    uint32_t ticks = (uint32_t)(left_us < SLEEP_MAX_US ? left_us : SLEEP_MAX_US) * TICKS_PER_US;
    TIMER1->reload = ticks;
    TIMER1->value = ticks;
    TIMER1->control = TIMER_ENABLE | TIMER_INTERRUPT_ENABLE;
    __asm volatile("dsb\n\twfi" ::: "memory");
    TIMER1->control = 0;
    TIMER1->interrupt = 1;
    NVIC_CLEAR_PENDING = IRQ_TIMER1 | IRQ_UART0_RX;
}

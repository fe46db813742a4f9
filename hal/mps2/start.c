/*
 * Reset and faults of a Cortex-M4 or M55 image.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdint.h>

#include "tsr/hal/mps2_semihosting.h"
#include "tsr/hal/mps2_stack.h"

/* ARMv7-M Architecture Reference Manual, B3.2.20: full access to CP10 and CP11, the FPU and MVE. */
#define CPACR (*(volatile uint32_t *)0xe000ed88u)
#define CPACR_FPU (UINT32_C(0xf) << 20)

#define STACK_PAINT UINT32_C(0x5ac3a53c)
#define EXIT_FAULT 99

/* From the linker script. */
extern uint32_t tsr_mps2_stack_limit[], tsr_mps2_stack_top[];
extern uint32_t tsr_mps2_data_start[], tsr_mps2_data_end[], tsr_mps2_data_source[];
extern uint32_t tsr_mps2_bss_start[], tsr_mps2_bss_end[], tsr_mps2_lab_start[], tsr_mps2_lab_end[];

int main(void);
_Noreturn void tsr_mps2_reset(void);

static void clear(uint32_t *from, const uint32_t *to)
{
    while (from < to) {
        *from++ = 0;
    }
}

/* Everything below this function's own frame. */
static void paint_stack(void)
{
    uint32_t mark = STACK_PAINT;
    for (volatile uint32_t *word = tsr_mps2_stack_limit; word < &mark; word++) {
        *word = STACK_PAINT;
    }
}

size_t tsr_mps2_stack_used_len(void)
{
    const uint32_t *word = tsr_mps2_stack_limit;
    while (word < tsr_mps2_stack_top && *word == STACK_PAINT) {
        word++;
    }
    return (size_t)(tsr_mps2_stack_top - word) * sizeof *word;
}

size_t tsr_mps2_stack_len(void)
{
    return (size_t)(tsr_mps2_stack_top - tsr_mps2_stack_limit) * sizeof(uint32_t);
}

_Noreturn void tsr_mps2_reset(void)
{
    CPACR |= CPACR_FPU;
    __asm volatile("dsb\n\tisb" ::: "memory");
    const uint32_t *source = tsr_mps2_data_source;
    for (uint32_t *word = tsr_mps2_data_start; word < tsr_mps2_data_end; word++) {
        *word = *source++;
    }
    clear(tsr_mps2_bss_start, tsr_mps2_bss_end);
    clear(tsr_mps2_lab_start, tsr_mps2_lab_end);
    paint_stack();
    tsr_mps2_exit(main());
}

static void fault(void)
{
    tsr_mps2_exit(EXIT_FAULT);
}

union vector {
    void (*handler)(void);
    uint32_t *stack;
};

/* ARMv7-M, B1.5.3. No interrupt is ever taken (clock.c waits with them masked). */
__attribute__((section(".vectors"), used)) static const union vector kVectors[16] = {
    {.stack = tsr_mps2_stack_top},
    {.handler = tsr_mps2_reset},
    {.handler = fault},
    {.handler = fault},
    {.handler = fault},
    {.handler = fault},
    {.handler = fault},
    {.handler = fault},
    {.handler = fault},
    {.handler = fault},
    {.handler = fault},
    {.handler = fault},
    {.handler = fault},
    {.handler = fault},
    {.handler = fault},
    {.handler = fault},
};

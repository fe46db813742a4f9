/*
 * The markers between which instructions are counted, and the names of what was.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "workbench.h"

#define WORK_LINES_CAP 2048u

static char work_lines[WORK_LINES_CAP];
static size_t work_lines_len;

void workbench_expect(bool held, const char *what)
{
    if (!held) {
        workbench_fail(what);
    }
}

/* Empty functions at known addresses: tests/target/icount.c counts between them. */
__attribute__((noinline, used)) void workbench_begin(void)
{
    __asm volatile("" ::: "memory");
}

__attribute__((noinline, used)) static void workbench_stop(void)
{
    __asm volatile("" ::: "memory");
}

static void put_char(char character)
{
    workbench_expect(work_lines_len < WORK_LINES_CAP, "work.txt: too long");
    work_lines[work_lines_len++] = character;
}

void workbench_end(const char *work, size_t units)
{
    workbench_stop();
    while (*work != '\0') {
        put_char(*work++);
    }
    put_char(' ');
    uint32_t divisor = 1;
    while (units / divisor >= 10u) {
        divisor *= 10u;
    }
    for (; divisor > 0; divisor /= 10u) {
        put_char((char)('0' + units / divisor % 10u));
    }
    put_char('\n');
}

void workbench_store_work(void)
{
    workbench_store("work.txt", work_lines, work_lines_len);
}

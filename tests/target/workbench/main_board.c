/*
 * The workbench on the board: workbench WIDTH HEIGHT DISPARITIES, files by semihosting.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/hal/mps2_aes.h"
#include "tsr/hal/mps2_semihosting.h"
#include "workbench.h"

#define LINE_CAP 80u

const struct tsr_aes_ops *const workbench_aes = &tsr_mps2_aes;

_Noreturn void workbench_fail(const char *what)
{
    tsr_mps2_print("workbench: ");
    tsr_mps2_print(what);
    tsr_mps2_print("\n");
    tsr_mps2_exit(2);
}

void workbench_load(const char *name, uint8_t *bytes, size_t len)
{
    workbench_expect(tsr_mps2_read_file(name, 0, bytes, len) == TSR_OK, name);
}

void workbench_store(const char *name, const void *bytes, size_t len)
{
    workbench_expect(tsr_mps2_write_file(name, bytes, len) == TSR_OK, name);
}

/* The number after the next blank. */
static uint16_t read_number(const char **line)
{
    while (**line != '\0' && **line != ' ') {
        (*line)++;
    }
    uint32_t number = 0;
    while (**line == ' ') {
        (*line)++;
    }
    for (; **line >= '0' && **line <= '9'; (*line)++) {
        number = number * 10u + (uint32_t)(**line - '0');
    }
    return (uint16_t)number;
}

/* Two instructions a turn: the counter's own check. */
static void run_turns(unsigned turns, const char *work)
{
    workbench_begin();
    __asm volatile("1:\n\tsubs %0, #1\n\tbne 1b" : "+l"(turns) : : "cc");
    workbench_end(work, 1);
}

int main(void)
{
    static char line[LINE_CAP];
    workbench_expect(tsr_mps2_command_line(line, sizeof line) == TSR_OK, "command line");
    const char *at = line;
    struct workbench_case bench;
    bench.width = read_number(&at);
    bench.height = read_number(&at);
    bench.disparities = read_number(&at);
    run_turns(500, "calibration_1000");
    run_turns(1000, "calibration_2000");
    workbench_run(&bench);
    return 0;
}

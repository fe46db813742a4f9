/*
 * Semihosting: files, console and end of program, served by QEMU or a debugger.
 *
 * ARM "Semihosting for AArch32 and AArch64", release 2.0: operation in r0,
 * parameter block in r1, BKPT 0xAB. Without a host the instruction is a fault.
 * Every call stops the processor until the host has answered.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_MPS2_SEMIHOSTING_H
#define TSR_HAL_MPS2_SEMIHOSTING_H

#include <stddef.h>
#include <stdint.h>

#include "tsr/base/status.h"

/* Read exactly len bytes of a file from offset. TSR_ERR_IO: not there, or shorter. */
enum tsr_status tsr_mps2_read_file(const char *name, size_t offset, uint8_t *bytes, size_t len);

/* Write a file of these bytes. TSR_ERR_IO. */
enum tsr_status tsr_mps2_write_file(const char *name, const uint8_t *bytes, size_t len);

/* The words that the host passes, separated by blanks; zero-terminated.
 * TSR_ERR_NOBUF: longer than line_cap - 1. */
enum tsr_status tsr_mps2_command_line(char *line, size_t line_cap);

void tsr_mps2_print(const char *text);
void tsr_mps2_print_char(char character);
void tsr_mps2_print_number(uint32_t number);

/* End the program with this exit code (SYS_EXIT_EXTENDED). */
_Noreturn void tsr_mps2_exit(int code);

#endif

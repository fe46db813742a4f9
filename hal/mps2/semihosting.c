/*
 * Semihosting calls.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/hal/mps2_semihosting.h"

#include <string.h>

/* Operation numbers, chapter 6 of the specification. */
enum operation {
    SYS_OPEN = 0x01,
    SYS_CLOSE = 0x02,
    SYS_WRITEC = 0x03,
    SYS_WRITE0 = 0x04,
    SYS_WRITE = 0x05,
    SYS_READ = 0x06,
    SYS_SEEK = 0x0a,
    SYS_GET_CMDLINE = 0x15,
    SYS_EXIT_EXTENDED = 0x20
};

/* Modes of SYS_OPEN: those of fopen, "rb" and "wb". */
#define OPEN_READ 1u
#define OPEN_WRITE 5u

#define APPLICATION_EXIT UINT32_C(0x20026) /* ADP_Stopped_ApplicationExit */
#define NUMBER_CAP 11                      /* 2^32 - 1 and its zero */

static int call(enum operation operation, const void *parameters)
{
    register int r0 __asm("r0") = (int)operation;
    register const void *r1 __asm("r1") = parameters;
    __asm volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

static uint32_t address_of(const void *object)
{
    return (uint32_t)(uintptr_t)object;
}

static int open_file(const char *name, uint32_t mode)
{
    const uint32_t parameters[3] = {address_of(name), mode, (uint32_t)strlen(name)};
    return call(SYS_OPEN, parameters);
}

static void close_file(int file)
{
    const uint32_t parameters[1] = {(uint32_t)file};
    (void)call(SYS_CLOSE, parameters);
}

enum tsr_status tsr_mps2_read_file(const char *name, size_t offset, uint8_t *bytes, size_t len)
{
    int file = open_file(name, OPEN_READ);
    if (file < 0) {
        return TSR_ERR_IO;
    }
    const uint32_t seek[2] = {(uint32_t)file, (uint32_t)offset};
    const uint32_t read[3] = {(uint32_t)file, address_of(bytes), (uint32_t)len};
    /* SYS_READ returns the bytes that it did not read. */
    enum tsr_status status = call(SYS_SEEK, seek) == 0 && call(SYS_READ, read) == 0 ? TSR_OK : TSR_ERR_IO;
    close_file(file);
    return status;
}

enum tsr_status tsr_mps2_write_file(const char *name, const uint8_t *bytes, size_t len)
{
    int file = open_file(name, OPEN_WRITE);
    if (file < 0) {
        return TSR_ERR_IO;
    }
    const uint32_t write[3] = {(uint32_t)file, address_of(bytes), (uint32_t)len};
    enum tsr_status status = call(SYS_WRITE, write) == 0 ? TSR_OK : TSR_ERR_IO;
    close_file(file);
    return status;
}

enum tsr_status tsr_mps2_command_line(char *line, size_t line_cap)
{
    const uint32_t parameters[2] = {address_of(line), (uint32_t)line_cap};
    return call(SYS_GET_CMDLINE, parameters) == 0 ? TSR_OK : TSR_ERR_NOBUF;
}

void tsr_mps2_print(const char *text)
{
    (void)call(SYS_WRITE0, text);
}

void tsr_mps2_print_char(char character)
{
    (void)call(SYS_WRITEC, &character);
}

void tsr_mps2_print_number(uint32_t number)
{
    char digits[NUMBER_CAP];
    size_t at = sizeof digits - 1;
    digits[at] = '\0';
    do {
        digits[--at] = (char)('0' + number % 10u);
        number /= 10u;
    } while (number != 0);
    tsr_mps2_print(digits + at);
}

_Noreturn void tsr_mps2_exit(int code)
{
    const uint32_t parameters[2] = {APPLICATION_EXIT, (uint32_t)code};
    for (;;) {
        (void)call(SYS_EXIT_EXTENDED, parameters);
    }
}

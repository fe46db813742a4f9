/*
 * A heap for unit tests that allocate exact-size buffers; the firmware has none.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stddef.h>
#include <stdint.h>

#define HEAP_LEN 1048576

void *_sbrk(ptrdiff_t more);

static _Alignas(8) uint8_t heap[HEAP_LEN];
static ptrdiff_t used;

/* newlib's contract: the end of the heap before it grew, or (void *)-1. */
void *_sbrk(ptrdiff_t more)
{
    if (more > HEAP_LEN - used || more < -used) {
        return (void *)(intptr_t)-1;
    }
    void *end = heap + used;
    used += more;
    return end;
}

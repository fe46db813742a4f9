/*
 * Entropy: random bytes for back-off. Not for keys.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_ENTROPY_H
#define TSR_HAL_ENTROPY_H

#include <stddef.h>
#include <stdint.h>

struct tsr_entropy_ops {
    /* Fill bytes[len]. Never fails: a source that can is not one. */
    void (*fill)(void *entropy, uint8_t *bytes, size_t len);
};

struct tsr_entropy {
    const struct tsr_entropy_ops *ops;
    void *self;
};

#endif

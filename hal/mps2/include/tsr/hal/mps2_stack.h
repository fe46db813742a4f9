/*
 * How much stack has been used since reset, from the paint that reset leaves.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_MPS2_STACK_H
#define TSR_HAL_MPS2_STACK_H

#include <stddef.h>

/* Bytes from the top to the deepest word that was ever written. A frame whose
 * last words were never written counts less than it reserved. */
size_t tsr_mps2_stack_used_len(void);

/* Bytes that the linker script reserves. */
size_t tsr_mps2_stack_len(void);

#endif

/*
 * The AES-128 block by Mbed TLS 2.28, in software, tables in flash, nothing allocated.
 *
 * Its tables are read at addresses that depend on the key: on a part with a
 * cache an observer of its timing may learn from that. A chip's own AES takes
 * its place where there is one.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_MPS2_AES_H
#define TSR_HAL_MPS2_AES_H

#include "tsr/base/aes.h"

extern const struct tsr_aes_ops tsr_mps2_aes;

#endif

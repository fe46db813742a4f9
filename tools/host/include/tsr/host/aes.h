/*
 * The AES block operation of tsr/base/aes.h by Mbed TLS, for the sink and tools.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_AES_H
#define TSR_HOST_AES_H

extern "C" {
#include "tsr/base/aes.h"
}

namespace tsr
{

/* Static; safe from any thread. */
const tsr_aes_ops &mbedtls_aes_ops();

} // namespace tsr

#endif

/*
 * What of Mbed TLS a board carries: the AES block, nothing else.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_MBEDTLS_CONFIG_H
#define TSR_MBEDTLS_CONFIG_H

#define MBEDTLS_AES_C
#define MBEDTLS_AES_ROM_TABLES   /* in flash, not computed into RAM */
#define MBEDTLS_AES_FEWER_TABLES /* 1 KB of table instead of 4 */

#endif

/*
 * A translation unit so that the shared firmware library has a source.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
typedef int tsr_firmware_is_in_the_archives;

/*
 * A translation unit so that precompiled headers have an executable.
 *
 * SPDX-License-Identifier: Apache-2.0
 */

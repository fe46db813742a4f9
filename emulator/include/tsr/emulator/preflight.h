/*
 * All that can be refused before a run begins: so that bad input is one line
 * and nothing else, not a run that breaks off.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_PREFLIGHT_H
#define TSR_EMULATOR_PREFLIGHT_H

#include <cstdint>
#include <filesystem>

#include "tsr/host/keys.h"
#include "tsr/host/site.h"

namespace tsr
{

/* Longest recording: 24 hours of virtual time. */
inline constexpr std::uint64_t kRecordingMaxMs = 24ull * 3600 * 1000;

/* The firmware takes each node's configuration. Returns the octets of RAM of all nodes. Throws InputError. */
std::uint64_t check_nodes(const Site &site, const KeyRing &keys);

/* What this process may have: the machine's memory or, if that is less, its limit of address space (ulimit -v). */
std::uint64_t memory_there();

/* Refuses a site whose nodes and pictures need more octets than are there: the run would be killed half-way. Throws
 * InputError. */
void check_memory(const Site &site, const std::filesystem::path &file, std::uint64_t needed,
                  std::uint64_t there = memory_there());

/* Every camera has frames, every frame can be read, recordings end in time, and ground truth fits its pair. Throws
 * InputError. */
void check_recorded(const Site &site);

} // namespace tsr

#endif

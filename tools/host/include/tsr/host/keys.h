/*
 * The keys of a site, kept apart from site.toml in a file of mode 0600:
 *
 *   test = true                      # made from a seed: anybody can make it again
 *   link_key = "32 hex digits"       # all nodes: seals every 802.15.4 frame
 *   [[node]]
 *   id = 3
 *   key = "32 hex digits"            # this node and the sink alone
 *   [[pair]]
 *   lead = 3
 *   wing = 4
 *   key = "32 hex digits"            # the wing and its lead
 *
 * Test keys come from a seed by HKDF-SHA256 (RFC 5869):
 *
 *   PRK = HKDF-Extract(salt = "tarsier test keys 1", IKM = seed, 8 bytes little-endian)
 *   key = HKDF-Expand(PRK, info, 16) with info =
 *         "link" | "node" + id (2, LE) | "pair" + lead id (2, LE) + wing id (2, LE)
 *
 * Whatever talks to a real radio or board refuses a ring with test == true.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_KEYS_H
#define TSR_HOST_KEYS_H

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

namespace tsr
{

struct Site;

using Key = std::array<std::uint8_t, 16>;

struct KeyRing {
    bool test = false;
    Key link_key{};
    std::map<std::uint16_t, Key> node_keys;                           /* by node id */
    std::map<std::pair<std::uint16_t, std::uint16_t>, Key> pair_keys; /* by (lead id, wing id) */

    std::optional<Key> node_key(std::uint16_t id) const;
    std::optional<Key> pair_key(std::uint16_t lead_id, std::uint16_t wing_id) const;
    bool operator==(const KeyRing &) const = default;
};

/* A key for every node and every two-board pair of site; test is true. */
KeyRing derive_test_keys(std::uint64_t seed, const Site &site);
/* The same hierarchy from the kernel's random numbers; test is false. */
KeyRing make_random_keys(const Site &site);

/* Throws InputError: unreadable file, readable by group or others, unknown
 * field, a key that is not 32 hex digits, the same node or pair twice. */
KeyRing load_keys(const std::filesystem::path &file);
/* Refuses a ring that lacks a key for a node or two-board pair of site. */
void check_keys(const KeyRing &keys, const Site &site, const std::filesystem::path &file);
/* Creates or replaces file with mode 0600. */
void write_keys(const std::filesystem::path &file, const KeyRing &keys);

} // namespace tsr

#endif

/* The key hierarchy and its file. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/keys.h"

#include <cerrno>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <mbedtls/hkdf.h>
#include <mbedtls/md.h>
#include <sys/random.h>
#include <sys/stat.h>

#include "tsr/host/atomic_file.h"
#include "tsr/host/input_error.h"
#include "tsr/host/site.h"
#include "tsr/host/toml_fields.h"

namespace tsr
{
namespace
{

constexpr std::string_view kTestSalt = "tarsier test keys 1";
constexpr std::string_view kHexDigits = "0123456789abcdef";
constexpr unsigned kModePrivate = 0600;
constexpr unsigned kModeOthers = 077;

/* Fills a ring with one key for every node and two-board pair. */
template <typename MakeKey> KeyRing fill_ring(const Site &site, bool test, MakeKey make_key)
{
    KeyRing ring;
    ring.test = test;
    ring.link_key = make_key("link", {});
    for (const SiteNode &node : site.nodes) {
        ring.node_keys[node.id] = make_key("node", {node.id});
    }
    for (const SitePair &pair : site.pairs) {
        if (pair.wing != kNodeNone) {
            ring.pair_keys[{pair.lead, pair.wing}] = make_key("pair", {pair.lead, pair.wing});
        }
    }
    return ring;
}

std::vector<std::uint8_t> bytes_of(std::string_view text)
{
    return {text.begin(), text.end()};
}

Key expand_key(std::span<const std::uint8_t> prk, std::string_view label, const std::vector<std::uint16_t> &ids)
{
    std::vector<std::uint8_t> info = bytes_of(label);
    for (const std::uint16_t id : ids) {
        info.push_back(static_cast<std::uint8_t>(id));
        info.push_back(static_cast<std::uint8_t>(id >> 8));
    }
    Key key;
    if (mbedtls_hkdf_expand(mbedtls_md_info_from_type(MBEDTLS_MD_SHA256), prk.data(), prk.size(), info.data(),
                            info.size(), key.data(), key.size()) != 0) {
        throw std::runtime_error("Mbed TLS cannot derive a key");
    }
    return key;
}

Key random_key()
{
    Key key;
    const ssize_t got = ::getrandom(key.data(), key.size(), 0); /* up to 256 bytes come whole: getrandom(2) */
    if (got != static_cast<ssize_t>(key.size())) {
        throw std::runtime_error(std::string("getrandom: ") + std::strerror(errno));
    }
    return key;
}

std::string hex_of(const Key &key)
{
    std::string text;
    for (const std::uint8_t byte : key) {
        text += kHexDigits[byte >> 4];
        text += kHexDigits[byte & 15];
    }
    return text;
}

Key read_key(TomlFields &fields, std::string_view field)
{
    const std::string text = fields.string(field);
    Key key{};
    /* The reason never quotes the text: what is nearly a key stays secret. */
    if (text.size() != 2 * key.size()) {
        fields.refuse(field, std::to_string(text.size()) + " characters, a key is " + std::to_string(2 * key.size()) +
                                 " hex digits");
    }
    for (std::size_t i = 0; i < text.size(); i++) {
        const char c = (text[i] >= 'A' && text[i] <= 'F') ? static_cast<char>(text[i] - 'A' + 'a') : text[i];
        const std::size_t digit = kHexDigits.find(c);
        if (digit == std::string_view::npos) {
            fields.refuse(field, "character " + std::to_string(i + 1) + " is not a hex digit");
        }
        key[i / 2] = static_cast<std::uint8_t>(key[i / 2] << 4 | digit);
    }
    return key;
}

std::uint16_t read_id(TomlFields &fields, std::string_view field)
{
    return static_cast<std::uint16_t>(fields.integer(field, 1, kNodeIdMax));
}

void check_mode(const std::filesystem::path &file)
{
    struct stat status {
    };
    if (::stat(file.c_str(), &status) != 0) {
        throw InputError(file.string(), "", std::strerror(errno));
    }
    if ((status.st_mode & kModeOthers) != 0) {
        throw InputError(file.string(), "mode", "group or others may access the keys; use chmod 600");
    }
}

} // namespace

std::optional<Key> KeyRing::node_key(std::uint16_t id) const
{
    const auto found = node_keys.find(id);
    return found == node_keys.end() ? std::nullopt : std::optional<Key>(found->second);
}

std::optional<Key> KeyRing::pair_key(std::uint16_t lead_id, std::uint16_t wing_id) const
{
    const auto found = pair_keys.find({lead_id, wing_id});
    return found == pair_keys.end() ? std::nullopt : std::optional<Key>(found->second);
}

KeyRing derive_test_keys(std::uint64_t seed, const Site &site)
{
    std::array<std::uint8_t, 8> material{};
    for (std::size_t i = 0; i < material.size(); i++) {
        material[i] = static_cast<std::uint8_t>(seed >> (8 * i));
    }
    std::array<std::uint8_t, 32> prk{};
    const std::vector<std::uint8_t> salt = bytes_of(kTestSalt);
    if (mbedtls_hkdf_extract(mbedtls_md_info_from_type(MBEDTLS_MD_SHA256), salt.data(), salt.size(), material.data(),
                             material.size(), prk.data()) != 0) {
        throw std::runtime_error("Mbed TLS cannot derive a key");
    }
    return fill_ring(site, true, [&](std::string_view label, const std::vector<std::uint16_t> &ids) {
        return expand_key(prk, label, ids);
    });
}

KeyRing make_random_keys(const Site &site)
{
    return fill_ring(site, false, [](std::string_view, const std::vector<std::uint16_t> &) { return random_key(); });
}

KeyRing load_keys(const std::filesystem::path &file)
{
    check_mode(file);
    TomlFile toml(file);
    TomlFields top = toml.top();
    KeyRing ring;
    ring.test = top.boolean("test", false);
    ring.link_key = read_key(top, "link_key");
    for (TomlFields &fields : top.tables("node")) {
        const std::uint16_t id = read_id(fields, "id");
        if (!ring.node_keys.emplace(id, read_key(fields, "key")).second) {
            fields.refuse("id", "node " + std::to_string(id) + " has a key already");
        }
        fields.refuse_unknown();
    }
    for (TomlFields &fields : top.tables("pair")) {
        const std::uint16_t lead = read_id(fields, "lead");
        const std::uint16_t wing = read_id(fields, "wing");
        if (!ring.pair_keys.emplace(std::pair{lead, wing}, read_key(fields, "key")).second) {
            fields.refuse("lead", "this pair has a key already");
        }
        fields.refuse_unknown();
    }
    top.refuse_unknown();
    return ring;
}

void check_keys(const KeyRing &keys, const Site &site, const std::filesystem::path &file)
{
    for (const SiteNode &node : site.nodes) {
        if (!keys.node_keys.contains(node.id)) {
            throw InputError(file.string(), "node", "no key for node " + std::to_string(node.id));
        }
    }
    for (const SitePair &pair : site.pairs) {
        if (pair.wing != kNodeNone && !keys.pair_keys.contains({pair.lead, pair.wing})) {
            throw InputError(file.string(), "pair", "no key for pair '" + pair.name + "'");
        }
    }
}

void write_keys(const std::filesystem::path &file, const KeyRing &keys)
{
    std::string text = "# Keys of a Tarsier site; keep this file secret.\n";
    text += std::string("test = ") + (keys.test ? "true" : "false") + "\n";
    text += "link_key = \"" + hex_of(keys.link_key) + "\"\n";
    for (const auto &[id, key] : keys.node_keys) {
        text += "\n[[node]]\nid = " + std::to_string(id) + "\nkey = \"" + hex_of(key) + "\"\n";
    }
    for (const auto &[ids, key] : keys.pair_keys) {
        text += "\n[[pair]]\nlead = " + std::to_string(ids.first) + "\nwing = " + std::to_string(ids.second) +
                "\nkey = \"" + hex_of(key) + "\"\n";
    }
    write_file_atomically(file, text, kModePrivate);
}

} // namespace tsr

/* Key derivation and key files. SPDX-License-Identifier: Apache-2.0 */
#include <cstring>
#include <set>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "test_host_folder.h"
#include "test_host_site.h"
#include "tsr/host/aes.h"
#include "tsr/host/keys.h"

namespace tsr
{
namespace
{

using test::Folder;
using test::small_site;

std::filesystem::path put_keys(const Folder &folder, const std::string &text)
{
    const auto file = folder.put("keys.toml", text);
    ::chmod(file.c_str(), 0600);
    return file;
}

const std::string kZeros(32, '0');

TEST(HostKeys, DerivationIsTheDocumentedOne)
{
    /* Python's hmac and hashlib, RFC 5869 written out (docs/units.md), seed 1. */
    const KeyRing ring = derive_test_keys(1, small_site());
    const Key link{0x1b, 0x38, 0x3c, 0xa1, 0xa9, 0x87, 0x50, 0xf3, 0x85, 0x7c, 0xcb, 0x5e, 0xe2, 0x49, 0xf8, 0x82};
    const Key node3{0x80, 0x9b, 0xdd, 0xec, 0x0e, 0xd2, 0x1c, 0xfe, 0x85, 0xf5, 0x79, 0xbd, 0x04, 0xa7, 0x75, 0x57};
    const Key pair34{0x45, 0x89, 0x29, 0x3e, 0x6a, 0xc7, 0x01, 0x9c, 0x9b, 0x1e, 0x72, 0xe8, 0x98, 0x88, 0x28, 0xee};
    EXPECT_TRUE(ring.test);
    EXPECT_EQ(ring.link_key, link);
    EXPECT_EQ(ring.node_key(3), node3);
    EXPECT_EQ(ring.pair_key(3, 4), pair34);
    EXPECT_EQ(ring.node_key(99), std::nullopt);
    EXPECT_EQ(ring.pair_key(4, 3), std::nullopt);
}

TEST(HostKeys, AllKeysDiffer)
{
    const KeyRing first = derive_test_keys(1, small_site());
    const KeyRing second = derive_test_keys(2, small_site());
    const KeyRing random = make_random_keys(small_site());
    EXPECT_FALSE(random.test);
    std::set<Key> keys;
    for (const KeyRing *ring : {&first, &second, &random}) {
        keys.insert(ring->link_key);
        for (const auto &[id, key] : ring->node_keys) {
            keys.insert(key);
        }
        for (const auto &[ids, key] : ring->pair_keys) {
            keys.insert(key);
        }
    }
    EXPECT_EQ(keys.size(), 3u * (1 + 5 + 1));
}

TEST(HostKeys, RoundTripWithModePrivate)
{
    const Folder folder;
    const KeyRing ring = derive_test_keys(5, small_site());
    write_keys(folder / "keys.toml", ring);
    struct stat status {
    };
    ASSERT_EQ(::stat((folder / "keys.toml").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0600u);
    EXPECT_EQ(load_keys(folder / "keys.toml"), ring);
    EXPECT_EQ(test::refusal([&] { check_keys(ring, small_site(), "keys.toml"); }), "");
}

TEST(HostKeys, RefusesBadFiles)
{
    const Folder folder;
    const std::string link = "link_key = \"" + kZeros + "\"\n";
    EXPECT_REFUSED(load_keys(folder / "absent"), "absent: No such file");
    EXPECT_REFUSED(load_keys(put_keys(folder, "link_key = \"00\"")), "link_key: 2 characters, a key is 32 hex digits");
    EXPECT_REFUSED(load_keys(put_keys(folder, "link_key = \"" + kZeros + "0\"")), "link_key: 33 characters");
    EXPECT_REFUSED(load_keys(put_keys(folder, "link_key = \"g" + kZeros.substr(1) + "\"")), "character 1 is not a hex");
    EXPECT_REFUSED(load_keys(put_keys(folder, "test = true")), "link_key: is missing");
    EXPECT_REFUSED(load_keys(put_keys(folder, link + "master = 1")), "master: unknown field");
    EXPECT_REFUSED(load_keys(put_keys(folder, link + "[[node]]\nid = 0\nkey = \"" + kZeros + "\"")),
                   "id: 0 is outside");
    EXPECT_REFUSED(load_keys(put_keys(folder, link + "[[node]]\nid = 1\nkey = 5")), "key: is not a string");
    const std::string node = "[[node]]\nid = 1\nkey = \"" + kZeros + "\"\n";
    EXPECT_REFUSED(load_keys(put_keys(folder, link + node + node)), "node 1 has a key already");
    const auto open_file = put_keys(folder, link);
    ::chmod(open_file.c_str(), 0640);
    EXPECT_REFUSED(load_keys(open_file), "mode: group or others may access");
}

TEST(HostKeys, ARefusalNeverShowsAKey)
{
    const Folder folder;
    const std::string nearly = "deadbeefdeadbeefdeadbeefdeadbee";
    const std::string what = test::refusal([&] { load_keys(put_keys(folder, "link_key = \"" + nearly + "\"")); });
    EXPECT_NE(what, "");
    EXPECT_EQ(what.find("deadbeef"), std::string::npos);
}

TEST(HostKeys, EveryNodeAndPairNeedsOne)
{
    KeyRing ring = derive_test_keys(1, small_site());
    ring.pair_keys.clear();
    EXPECT_REFUSED(check_keys(ring, small_site(), "keys.toml"), "keys.toml: pair: no key for pair 'porch'");
    ring.node_keys.erase(5);
    EXPECT_REFUSED(check_keys(ring, small_site(), "keys.toml"), "keys.toml: node: no key for node 5");
}

TEST(HostAes, EncryptsTheStandardsExample)
{
    /* FIPS 197, Appendix B. */
    const Key key{0x2b, 0x7e, 0x15, 0x16, 0x28, 0xae, 0xd2, 0xa6, 0xab, 0xf7, 0x15, 0x88, 0x09, 0xcf, 0x4f, 0x3c};
    Key block{0x32, 0x43, 0xf6, 0xa8, 0x88, 0x5a, 0x30, 0x8d, 0x31, 0x31, 0x98, 0xa2, 0xe0, 0x37, 0x07, 0x34};
    const Key expected{0x39, 0x25, 0x84, 0x1d, 0x02, 0xdc, 0x09, 0xfb, 0xdc, 0x11, 0x85, 0x97, 0x19, 0x6a, 0x0b, 0x32};
    tsr_aes_key expanded;
    ASSERT_EQ(mbedtls_aes_ops().expand(&expanded, key.data()), TSR_OK);
    const tsr_aes_key moved = expanded;
    std::memset(&expanded, 0xaa, sizeof expanded);
    ASSERT_EQ(mbedtls_aes_ops().encrypt(&moved, block.data(), block.data()), TSR_OK);
    EXPECT_EQ(block, expected);
}

} // namespace
} // namespace tsr

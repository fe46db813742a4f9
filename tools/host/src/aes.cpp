/* AES-128 blocks by Mbed TLS. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/aes.h"

#include <cstdint>
#include <cstring>

#include <mbedtls/aes.h>

namespace tsr
{
namespace
{

/*
 * An mbedtls_aes_context points into itself (2.28, aes.h: rk), and a
 * tsr_aes_key may be copied like any struct: so the state keeps the key alone,
 * and a thread keeps the last key it expanded. Blocks of one message have one.
 */
class ExpandedKey
{
  public:
    ExpandedKey() { mbedtls_aes_init(&context_); }
    ~ExpandedKey() { mbedtls_aes_free(&context_); }
    ExpandedKey(const ExpandedKey &) = delete;
    ExpandedKey &operator=(const ExpandedKey &) = delete;

    /* Null if the library fails. */
    mbedtls_aes_context *of(const std::uint8_t *key)
    {
        if (!valid_ || std::memcmp(key_, key, sizeof key_) != 0) {
            std::memcpy(key_, key, sizeof key_);
            valid_ = mbedtls_aes_setkey_enc(&context_, key_, 8 * sizeof key_) == 0;
        }
        return valid_ ? &context_ : nullptr;
    }

  private:
    mbedtls_aes_context context_{};
    std::uint8_t key_[TSR_AES_KEY_LEN]{};
    bool valid_ = false;
};

enum tsr_status expand(struct tsr_aes_key *expanded, const std::uint8_t key[TSR_AES_KEY_LEN])
{
    std::memcpy(expanded->state, key, TSR_AES_KEY_LEN);
    return TSR_OK;
}

enum tsr_status encrypt(const struct tsr_aes_key *expanded, const std::uint8_t in[TSR_AES_BLOCK_LEN],
                        std::uint8_t out[TSR_AES_BLOCK_LEN])
{
    thread_local ExpandedKey last;
    mbedtls_aes_context *context = last.of(reinterpret_cast<const std::uint8_t *>(expanded->state));
    const bool done = context != nullptr && mbedtls_aes_crypt_ecb(context, MBEDTLS_AES_ENCRYPT, in, out) == 0;
    return done ? TSR_OK : TSR_ERR_IO;
}

} // namespace

const tsr_aes_ops &mbedtls_aes_ops()
{
    static constexpr tsr_aes_ops kOps{expand, encrypt};
    return kOps;
}

} // namespace tsr

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
 * tsr_aes_key may be copied like any struct: so the state keeps the key alone
 * and each block expands it, some 0.1 us on a host with AES instructions.
 */
enum tsr_status expand(struct tsr_aes_key *expanded, const std::uint8_t key[TSR_AES_KEY_LEN])
{
    std::memcpy(expanded->state, key, TSR_AES_KEY_LEN);
    return TSR_OK;
}

enum tsr_status encrypt(const struct tsr_aes_key *expanded, const std::uint8_t in[TSR_AES_BLOCK_LEN],
                        std::uint8_t out[TSR_AES_BLOCK_LEN])
{
    mbedtls_aes_context context;
    mbedtls_aes_init(&context);
    const bool done = mbedtls_aes_setkey_enc(&context, reinterpret_cast<const std::uint8_t *>(expanded->state),
                                             8 * TSR_AES_KEY_LEN) == 0 &&
                      mbedtls_aes_crypt_ecb(&context, MBEDTLS_AES_ENCRYPT, in, out) == 0;
    mbedtls_aes_free(&context);
    return done ? TSR_OK : TSR_ERR_IO;
}

} // namespace

const tsr_aes_ops &mbedtls_aes_ops()
{
    static constexpr tsr_aes_ops kOps{expand, encrypt};
    return kOps;
}

} // namespace tsr

/* A whole file in memory. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/read_file.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tsr/host/input_error.h"

namespace tsr
{
namespace
{

struct Descriptor {
    int value;
    explicit Descriptor(int descriptor) : value(descriptor) {}
    Descriptor(const Descriptor &) = delete;
    Descriptor &operator=(const Descriptor &) = delete;
    ~Descriptor()
    {
        if (value >= 0) {
            ::close(value);
        }
    }
};

template <typename Bytes> void read_into(Bytes &bytes, const std::filesystem::path &file, std::size_t max_len)
{
    /* O_NONBLOCK: opening a pipe must fail below, not wait for a writer. */
    const Descriptor in(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (in.value < 0) {
        throw InputError(file.string(), "", std::strerror(errno));
    }
    struct stat status {
    };
    if (::fstat(in.value, &status) != 0) {
        throw InputError(file.string(), "", std::strerror(errno));
    }
    if (!S_ISREG(status.st_mode)) {
        throw InputError(file.string(), "", "not a regular file");
    }
    const auto len = static_cast<std::size_t>(status.st_size);
    if (len > max_len) {
        throw InputError(file.string(), "",
                         std::to_string(len) + " bytes, at most " + std::to_string(max_len) + " are read");
    }
    bytes.resize(len);
    std::size_t at = 0;
    while (at < len) {
        const ssize_t got = ::read(in.value, bytes.data() + at, len - at);
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got < 0) {
            throw InputError(file.string(), "", std::strerror(errno));
        }
        if (got == 0) {
            break; /* shortened while it was read */
        }
        at += static_cast<std::size_t>(got);
    }
    bytes.resize(at);
}

} // namespace

std::vector<std::uint8_t> read_file(const std::filesystem::path &file, std::size_t max_len)
{
    std::vector<std::uint8_t> bytes;
    read_into(bytes, file, max_len);
    return bytes;
}

std::string read_text_file(const std::filesystem::path &file, std::size_t max_len)
{
    std::string text;
    read_into(text, file, max_len);
    return text;
}

} // namespace tsr

/* Sockets and serial ports. SPDX-License-Identifier: Apache-2.0 */
#include "endpoints.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <netdb.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <termios.h>

#include "tsr/host/input_error.h"

namespace tsr
{
namespace
{

constexpr int kBacklog = 4;

[[noreturn]] void refuse(const ListenAddress &address, const char *step, const std::string &reason)
{
    throw InputError(address.place, step, reason);
}

[[noreturn]] void refuse(const ListenAddress &address, const char *step)
{
    refuse(address, step, std::strerror(errno));
}

/* Remove a socket file nobody listens at. */
void clear_stale(const ListenAddress &address, const sockaddr_un &name)
{
    struct stat status {
    };
    if (::lstat(name.sun_path, &status) != 0) {
        return;
    }
    if (!S_ISSOCK(status.st_mode)) {
        refuse(address, "path", "exists and is not a socket");
    }
    const Descriptor probe(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    /* EAGAIN: somebody listens, with a full backlog. */
    if (::connect(probe.get(), reinterpret_cast<const sockaddr *>(&name), sizeof name) == 0 || errno == EAGAIN) {
        refuse(address, "path", "another sink listens here");
    }
    ::unlink(name.sun_path);
}

Descriptor listen_unix(const ListenAddress &address)
{
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    std::memcpy(name.sun_path, address.place.data(), address.place.size());
    clear_stale(address, name);
    Descriptor listener(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (listener.get() < 0 || ::bind(listener.get(), reinterpret_cast<const sockaddr *>(&name), sizeof name) != 0) {
        refuse(address, "bind");
    }
    if (::listen(listener.get(), kBacklog) != 0) {
        refuse(address, "listen");
    }
    return listener;
}

Descriptor listen_tcp(const ListenAddress &address)
{
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = AI_PASSIVE;
    addrinfo *found = nullptr;
    const int error = ::getaddrinfo(address.place.c_str(), address.port.c_str(), &hints, &found);
    if (error != 0) {
        refuse(address, "host", ::gai_strerror(error));
    }
    Descriptor listener;
    int failure = 0;
    for (const addrinfo *at = found; at != nullptr && listener.get() < 0; at = at->ai_next) {
        Descriptor candidate(::socket(at->ai_family, at->ai_socktype | SOCK_CLOEXEC | SOCK_NONBLOCK, at->ai_protocol));
        const int on = 1;
        if (candidate.get() >= 0 && ::setsockopt(candidate.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) == 0 &&
            ::bind(candidate.get(), at->ai_addr, at->ai_addrlen) == 0 && ::listen(candidate.get(), kBacklog) == 0) {
            listener = std::move(candidate);
        } else {
            failure = errno;
        }
    }
    ::freeaddrinfo(found);
    if (listener.get() < 0) {
        refuse(address, "bind", std::strerror(failure));
    }
    return listener;
}

speed_t speed_of(const ListenAddress &address)
{
    static constexpr std::array<std::pair<unsigned, speed_t>, 9> kSpeeds{{{9600, B9600},
                                                                          {19200, B19200},
                                                                          {38400, B38400},
                                                                          {57600, B57600},
                                                                          {115200, B115200},
                                                                          {230400, B230400},
                                                                          {460800, B460800},
                                                                          {921600, B921600},
                                                                          {1000000, B1000000}}};
    for (const auto &[baud, speed] : kSpeeds) {
        if (baud == address.baud) {
            return speed;
        }
    }
    refuse(address, "baud", std::to_string(address.baud) + " is not one of 9600 .. 921600, 1000000");
}

Descriptor open_serial(const ListenAddress &address)
{
    const speed_t speed = speed_of(address);
    Descriptor port(::open(address.place.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
    if (port.get() < 0) {
        refuse(address, "open");
    }
    termios settings{};
    if (::tcgetattr(port.get(), &settings) != 0) {
        refuse(address, "open", "not a serial port");
    }
    ::cfmakeraw(&settings);
    settings.c_cflag |= CLOCAL | CREAD;
    settings.c_cc[VMIN] = 1;
    settings.c_cc[VTIME] = 0;
    if (::cfsetspeed(&settings, speed) != 0 || ::tcsetattr(port.get(), TCSAFLUSH, &settings) != 0) {
        refuse(address, "baud");
    }
    return port;
}

Descriptor take_inherited(const ListenAddress &address)
{
    int type = 0;
    socklen_t len = sizeof type;
    if (::getsockopt(address.descriptor, SOL_SOCKET, SO_TYPE, &type, &len) != 0) {
        refuse(address, "number");
    }
    sockaddr_storage peer{};
    len = sizeof peer;
    if (type != SOCK_STREAM || ::getpeername(address.descriptor, reinterpret_cast<sockaddr *>(&peer), &len) != 0) {
        refuse(address, "number", "is not a connected stream socket");
    }
    Descriptor link(address.descriptor);
    if (::fcntl(link.get(), F_SETFL, O_NONBLOCK) != 0 || ::fcntl(link.get(), F_SETFD, FD_CLOEXEC) != 0) {
        refuse(address, "number");
    }
    return link;
}

} // namespace

Descriptor open_listener(const ListenAddress &address)
{
    return address.kind == ListenAddress::Kind::tcp ? listen_tcp(address) : listen_unix(address);
}

Descriptor open_link(const ListenAddress &address)
{
    return address.kind == ListenAddress::Kind::serial ? open_serial(address) : take_inherited(address);
}

} // namespace tsr

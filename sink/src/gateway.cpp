/* poll(2) over the listener and its connections. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/sink/gateway.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <memory>
#include <stdexcept>

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/signalfd.h>
#include <sys/socket.h>

#include "descriptor.h"
#include "endpoints.h"

namespace tsr
{
namespace
{

constexpr std::size_t kConnectionsMax = 64;
constexpr std::size_t kReadLen = 65536;
/* A peer that asks and never reads is dropped when this much waits for it. */
constexpr std::size_t kOutgoingMax = std::size_t{1} << 20;

/* A gateway says HELLO at once. Who says nothing must not keep a place from one. */
constexpr std::chrono::seconds kSilenceMax{10};
/* After a connection that could not be taken for want of descriptors or memory. */
constexpr std::chrono::seconds kAcceptPause{1};

struct Peer {
    Descriptor descriptor;
    LinkSession session;
    std::chrono::steady_clock::time_point since = std::chrono::steady_clock::now();
    bool closed = false;
};

Descriptor open_signals()
{
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    if (::sigprocmask(SIG_BLOCK, &signals, nullptr) != 0) {
        throw std::runtime_error(std::string("sigprocmask: ") + std::strerror(errno));
    }
    std::signal(SIGPIPE, SIG_IGN); /* a lost peer is an error of write(2) */
    Descriptor descriptor(::signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK));
    if (descriptor.get() < 0) {
        throw std::runtime_error(std::string("signalfd: ") + std::strerror(errno));
    }
    return descriptor;
}

} // namespace

class Gateways::Loop
{
  public:
    Loop(const ListenAddress &address, const GatewayOptions &options)
        : address_(address), options_(options), signals_(open_signals())
    {
        if (address.is_one_link()) {
            add_peer(open_link(address));
        } else {
            listener_ = open_listener(address);
        }
    }
    Loop(const Loop &) = delete;
    Loop &operator=(const Loop &) = delete;
    ~Loop()
    {
        if (address_.kind == ListenAddress::Kind::unix_socket && listener_.get() >= 0) {
            ::unlink(address_.place.c_str());
        }
    }

    void run(LinkServer &server)
    {
        options_.log("listening at " + address_.place);
        while (!finished()) {
            std::vector<pollfd> waits = wait();
            if (waits[0].revents != 0) {
                options_.log("stopping on a signal");
                return;
            }
            if (waits[1].revents != 0) {
                accept_peer();
            }
            read_all(server, waits);
            write_all();
            close_silent();
            drop_closed();
        }
    }

  private:
    bool finished() const
    {
        const bool last_has_gone = served_ && peers_.empty();
        return last_has_gone && (options_.once || address_.is_one_link());
    }

    /* [0] signals, [1] listener (or nothing), then the peers in order. */
    std::vector<pollfd> wait()
    {
        std::vector<pollfd> waits{{signals_.get(), POLLIN, 0}, {listener_.get(), POLLIN, 0}};
        const bool pausing = std::chrono::steady_clock::now() < no_accept_before_;
        if (peers_.size() >= kConnectionsMax || pausing) {
            waits[1].fd = -1;
        }
        for (const auto &peer : peers_) {
            const short events = peer->session.outgoing().empty() ? POLLIN : POLLIN | POLLOUT;
            waits.push_back({peer->descriptor.get(), events, 0});
        }
        const int timeout_ms = anybody_silent() || pausing ? 1000 : -1;
        if (::poll(waits.data(), waits.size(), timeout_ms) < 0 && errno != EINTR) {
            throw std::runtime_error(std::string("poll: ") + std::strerror(errno));
        }
        return waits;
    }

    /* Over a serial port the gateway may have said its HELLO to an earlier sink; who started this one says it when
     * it pleases. */
    bool must_speak(const Peer &peer) const { return !address_.is_one_link() && !peer.session.has_spoken(); }

    bool anybody_silent() const
    {
        return std::any_of(peers_.begin(), peers_.end(), [this](const auto &peer) { return must_speak(*peer); });
    }

    void close_silent()
    {
        const auto now = std::chrono::steady_clock::now();
        for (const auto &peer : peers_) {
            if (must_speak(*peer) && now - peer->since > kSilenceMax) {
                options_.log("a connection said nothing a gateway says; closed");
                peer->closed = true;
            }
        }
    }

    void add_peer(Descriptor descriptor)
    {
        auto peer = std::make_unique<Peer>();
        peer->descriptor = std::move(descriptor);
        peers_.push_back(std::move(peer));
        served_ = true;
    }

    void accept_peer()
    {
        Descriptor descriptor(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
        if (descriptor.get() < 0) {
            if (errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM) {
                /* It stays in the queue, and the listener ready: not to be asked again at once. */
                options_.log(std::string("a connection waits: ") + std::strerror(errno));
                no_accept_before_ = std::chrono::steady_clock::now() + kAcceptPause;
            }
            return; /* else it went away again */
        }
        const int on = 1;
        ::setsockopt(descriptor.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on); /* fails on Unix sockets: no harm */
        options_.log("a gateway connected");
        add_peer(std::move(descriptor));
    }

    void read_all(LinkServer &server, const std::vector<pollfd> &waits)
    {
        std::vector<LinkServer::Input> inputs;
        for (std::size_t i = 0; i + 2 < waits.size(); i++) { /* a peer accepted just now waits for the next round */
            Peer &peer = *peers_[i];
            if ((waits[i + 2].revents & (POLLIN | POLLHUP | POLLERR)) == 0) {
                continue;
            }
            const ssize_t got = ::read(peer.descriptor.get(), buffer_.data(), buffer_.size());
            if (got > 0) {
                inputs.push_back({&peer.session, {buffer_.begin(), buffer_.begin() + got}});
            } else if (got == 0 || (errno != EAGAIN && errno != EINTR)) {
                peer.closed = true;
            }
        }
        server.process(inputs);
    }

    void write_all()
    {
        for (const auto &peer : peers_) {
            std::vector<std::uint8_t> &bytes = peer->session.outgoing();
            if (bytes.empty() || peer->closed) {
                continue;
            }
            const ssize_t sent = ::write(peer->descriptor.get(), bytes.data(), bytes.size());
            if (sent > 0) {
                bytes.erase(bytes.begin(), bytes.begin() + sent);
            } else if (sent < 0 && errno != EAGAIN && errno != EINTR) {
                peer->closed = true;
            }
            if (bytes.size() > kOutgoingMax) {
                options_.log("a gateway does not read its answers; connection closed");
                peer->closed = true;
            }
        }
    }

    void drop_closed()
    {
        const auto closed = std::erase_if(peers_, [](const std::unique_ptr<Peer> &peer) { return peer->closed; });
        if (closed > 0) {
            options_.log("a gateway disconnected");
        }
    }

    ListenAddress address_;
    GatewayOptions options_;
    Descriptor signals_;
    Descriptor listener_;
    std::vector<std::unique_ptr<Peer>> peers_;
    std::array<std::uint8_t, kReadLen> buffer_{};
    bool served_ = false;
    std::chrono::steady_clock::time_point no_accept_before_{};
};

Gateways::Gateways(const ListenAddress &address, const GatewayOptions &options)
    : loop_(std::make_unique<Loop>(address, options))
{
}

Gateways::~Gateways() = default;

void Gateways::serve(LinkServer &server)
{
    loop_->run(server);
}

} // namespace tsr

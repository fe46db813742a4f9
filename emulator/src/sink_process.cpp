/*
 * Starting, restarting and asking the sink process.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/emulator/sink_process.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tsr/host/input_error.h"

extern "C" {
#include "tsr/wire/link.h"
}

extern char **environ; /* POSIX, environ(7) */

namespace tsr
{

namespace
{

constexpr int kConnectTries = 500; /* of 10 ms: a loaded machine may be slow to start it */
constexpr int kAnswerTimeoutMs = 30'000;
/* In a row, without one answer between them: then it is not killed, it cannot live. */
constexpr unsigned kFailuresMax = 200;

/* Type and sequence of an encoded frame; type 0 if it is none. */
tsr_link_frame decode_frame(const std::uint8_t *bytes, std::size_t len)
{
    tsr_link_decoder decoder;
    tsr_link_decoder_init(&decoder);
    tsr_link_frame frame{};
    for (std::size_t i = 0; i < len; ++i) {
        if (tsr_link_decode(&decoder, bytes[i], &frame) == TSR_OK) {
            frame.body = nullptr; /* the decoder goes away */
            return frame;
        }
    }
    return {};
}

} // namespace

SinkProcess::SinkProcess(Options options)
    : options_(std::move(options)), socket_path_(options_.database.parent_path() / "sink.socket")
{
    if (socket_path_.string().size() >= sizeof(sockaddr_un::sun_path)) {
        /* A Unix socket's path has 107 bytes at most; out folders may be deeper. */
        socket_path_ = std::filesystem::path("/tmp") / ("tarsier-" + std::to_string(getpid()) + ".socket");
    }
    start();
}

SinkProcess::~SinkProcess()
{
    disconnect();
    if (pid_ > 0) {
        kill(pid_, SIGKILL);
        reap(true);
    }
    std::error_code ignored;
    std::filesystem::remove(socket_path_, ignored);
}

void SinkProcess::start()
{
    std::error_code ignored;
    std::filesystem::remove(socket_path_, ignored);
    const std::vector<std::string> words = {options_.program.string(),
                                            options_.site.string(),
                                            "--keys",
                                            options_.keys.string(),
                                            "--db",
                                            options_.database.string(),
                                            "--listen",
                                            "unix:" + socket_path_.string(),
                                            "--out",
                                            options_.out.string(),
                                            "--once"}; /* it ends with this process, however that ends */
    std::vector<char *> argv;
    for (const std::string &word : words) {
        argv.push_back(const_cast<char *>(word.c_str())); /* posix_spawn does not change them */
    }
    argv.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, options_.log.c_str(), O_WRONLY | O_CREAT | O_APPEND,
                                     0644);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    /* A process group of its own: a Ctrl-C is this program's to deal with. */
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    const int error = posix_spawn(&pid_, options_.program.c_str(), &actions, &attributes, argv.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) {
        pid_ = -1;
        throw InputError(options_.program.string(), "run", std::strerror(error));
    }
}

/* Notice a process that has ended; with wait, until it has. */
void SinkProcess::reap(bool wait)
{
    int status = 0;
    if (pid_ <= 0 || waitpid(pid_, &status, wait ? 0 : WNOHANG) != pid_) {
        return;
    }
    pid_ = -1;
    if (WIFEXITED(status) && WEXITSTATUS(status) == kExitInput) {
        throw InputError(options_.log.string(), "tarsier-sink", "refused its input; its last line says why");
    }
}

bool SinkProcess::connect_socket()
{
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, socket_path_.c_str(), sizeof(address.sun_path) - 1);
    for (int attempt = 0; attempt < kConnectTries; ++attempt) {
        reap(false);
        if (pid_ <= 0) {
            return false;
        }
        socket_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
        if (socket_ >= 0 && connect(socket_, reinterpret_cast<const sockaddr *>(&address), sizeof address) == 0) {
            return true;
        }
        disconnect();
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

void SinkProcess::disconnect()
{
    if (socket_ >= 0) {
        close(socket_);
        socket_ = -1;
    }
}

bool SinkProcess::send_all(const std::uint8_t *bytes, std::size_t len)
{
    while (len > 0) {
        const ssize_t sent = send(socket_, bytes, len, MSG_NOSIGNAL);
        if (sent <= 0 && errno != EINTR) {
            return false;
        }
        if (sent > 0) {
            bytes += sent;
            len -= static_cast<std::size_t>(sent);
        }
    }
    return true;
}

bool SinkProcess::read_answer(std::uint16_t sequence, std::vector<std::uint8_t> &answer)
{
    tsr_link_decoder decoder;
    tsr_link_decoder_init(&decoder);
    std::vector<std::uint8_t> bytes;
    for (;;) {
        pollfd waiting{socket_, POLLIN, 0};
        const int ready = poll(&waiting, 1, kAnswerTimeoutMs);
        if (ready < 0 && errno == EINTR) {
            continue;
        }
        std::uint8_t chunk[1024];
        const ssize_t got = ready > 0 ? recv(socket_, chunk, sizeof chunk, 0) : 0;
        if (got <= 0) {
            return false;
        }
        for (ssize_t i = 0; i < got; ++i) {
            bytes.push_back(chunk[i]);
            tsr_link_frame frame{};
            const tsr_status status = tsr_link_decode(&decoder, chunk[i], &frame);
            if (status == TSR_OK && frame.type == TSR_LINK_ANSWER && frame.sequence == sequence) {
                answer = std::move(bytes);
                return true;
            }
        }
    }
}

bool SinkProcess::try_exchange(const std::uint8_t *frame, std::size_t len, std::vector<std::uint8_t> &answer)
{
    const tsr_link_frame decoded = decode_frame(frame, len);
    if (socket_ < 0) {
        if (!connect_socket()) {
            return false;
        }
        const bool is_hello = decoded.type == TSR_LINK_HELLO;
        std::vector<std::uint8_t> ignored;
        if (!is_hello && !hello_.empty() &&
            (!send_all(hello_.data(), hello_.size()) ||
             !read_answer(decode_frame(hello_.data(), hello_.size()).sequence, ignored))) {
            return false;
        }
    }
    return send_all(frame, len) && read_answer(decoded.sequence, answer);
}

std::vector<std::uint8_t> SinkProcess::exchange(const std::uint8_t *frame, std::size_t len)
{
    if (decode_frame(frame, len).type == TSR_LINK_HELLO) {
        hello_.assign(frame, frame + len);
    }
    std::vector<std::uint8_t> answer;
    while (!try_exchange(frame, len, answer)) {
        recover();
    }
    failures_ = 0;
    return answer;
}

void SinkProcess::restart()
{
    disconnect();
    if (pid_ > 0) {
        kill(pid_, SIGKILL); /* alive but silent is as good as dead */
        reap(true);
    }
    ++restarts_;
    start();
}

/* After a failure: only so often without an answer between. */
void SinkProcess::recover()
{
    if (++failures_ > kFailuresMax) {
        throw InputError(options_.program.string(), "run",
                         "does not answer; " + options_.log.string() + " may say why");
    }
    restart();
}

bool SinkProcess::try_finish()
{
    /* Connected means that it takes signals as requests from now on. */
    if (socket_ < 0 && !connect_socket()) {
        return false;
    }
    disconnect();
    int status = 0;
    kill(pid_, SIGTERM);
    while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    if (WIFEXITED(status) && WEXITSTATUS(status) == kExitInput) {
        throw InputError(options_.log.string(), "tarsier-sink", "could not export; its last line says why");
    }
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

void SinkProcess::finish()
{
    while (!try_finish()) {
        recover();
    }
}

} // namespace tsr

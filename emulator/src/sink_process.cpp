/*
 * Starting, restarting and asking the sink process.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/emulator/sink_process.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
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

constexpr std::chrono::seconds kAnswerTimeout{30}; /* a loaded machine may be slow to start it */
constexpr std::chrono::seconds kAnswerTimeoutStopping{5};
constexpr int kLookMs = 100; /* for a signal */
/* In a row, without one answer between them: then it is not killed, it cannot live; and it will not answer. */
constexpr unsigned kFailuresMax = 200;
constexpr unsigned kSilencesMax = 3;

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

/* No path that begins with a hyphen is an option then. */
std::string absolute_text(const std::filesystem::path &path)
{
    return std::filesystem::absolute(path).string();
}

/* What a program that has refused something said. */
std::string last_line(const std::filesystem::path &log)
{
    std::ifstream file(log);
    std::string last = "refuses its input";
    for (std::string line; std::getline(file, line);) {
        last = line.empty() ? last : line;
    }
    return last;
}

} // namespace

SinkProcess::SinkProcess(Options options) : options_(std::move(options))
{
    start();
}

SinkProcess::~SinkProcess()
{
    disconnect();
    if (pid_ > 0) {
        kill(pid_, SIGKILL);
        int ignored = 0;
        waitpid(pid_, &ignored, 0);
    }
}

void SinkProcess::start()
{
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
        throw InputError(options_.program.string(), "run", std::strerror(errno));
    }
    socket_ = ends[0];
    std::vector<std::string> words = {options_.program.string(),
                                      absolute_text(options_.site),
                                      "--keys",
                                      absolute_text(options_.keys),
                                      "--db",
                                      absolute_text(options_.database),
                                      "--listen",
                                      "fd:" + std::to_string(ends[1]),
                                      "--out",
                                      absolute_text(options_.out)};
    std::vector<char *> argv;
    std::transform(words.begin(), words.end(), std::back_inserter(argv), [](std::string &word) { return word.data(); });
    argv.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, options_.log.c_str(), O_WRONLY | O_CREAT | O_APPEND,
                                     0644);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    posix_spawn_file_actions_adddup2(&actions, ends[1], ends[1]); /* the same number: open beyond exec */
    /* A process group of its own: a Ctrl-C is this program's to deal with. */
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    const int error = posix_spawn(&pid_, options_.program.c_str(), &actions, &attributes, argv.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    if (error != 0) {
        pid_ = -1;
        disconnect();
        throw InputError(options_.program.string(), "run", std::strerror(error));
    }
}

/* After its end. */
int SinkProcess::reap()
{
    int status = 0;
    while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    if (WIFEXITED(status) && WEXITSTATUS(status) == kExitInput) {
        throw InputError(options_.program.string(), "run", last_line(options_.log));
    }
    return status;
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

bool SinkProcess::is_readable()
{
    using Clock = std::chrono::steady_clock;
    const auto since = Clock::now();
    bool stopping = false;
    auto end = since + kAnswerTimeout;
    while (Clock::now() < end) {
        pollfd waiting{socket_, POLLIN, 0};
        if (poll(&waiting, 1, kLookMs) > 0) {
            return true;
        }
        if (!stopping && options_.stopping()) {
            stopping = true;
            end = std::min(end, Clock::now() + kAnswerTimeoutStopping);
        }
    }
    silences_ += stopping ? kSilencesMax : 1;
    return false;
}

bool SinkProcess::read_answer(std::uint16_t sequence)
{
    tsr_link_decoder decoder;
    tsr_link_decoder_init(&decoder);
    answer_.clear();
    while (is_readable()) {
        std::uint8_t chunk[1024];
        const ssize_t got = recv(socket_, chunk, sizeof chunk, 0);
        if (got <= 0) {
            return false;
        }
        for (ssize_t i = 0; i < got; ++i) {
            answer_.push_back(chunk[i]);
            tsr_link_frame frame{};
            const tsr_status status = tsr_link_decode(&decoder, chunk[i], &frame);
            if (status == TSR_OK && frame.type == TSR_LINK_ANSWER && frame.sequence == sequence) {
                return true;
            }
        }
    }
    return false;
}

bool SinkProcess::ask(const std::uint8_t *frame, std::size_t len)
{
    return send_all(frame, len) && read_answer(decode_frame(frame, len).sequence);
}

std::vector<std::uint8_t> SinkProcess::exchange(const std::uint8_t *frame, std::size_t len)
{
    const bool is_hello = decode_frame(frame, len).type == TSR_LINK_HELLO;
    if (is_hello) {
        hello_.assign(frame, frame + len);
    }
    for (;;) {
        const bool greeted = is_hello || greeted_ || hello_.empty() || ask(hello_.data(), hello_.size());
        if (greeted && ask(frame, len)) {
            greeted_ = true;
            failures_ = 0;
            silences_ = 0;
            return answer_;
        }
        recover();
    }
}

void SinkProcess::restart()
{
    disconnect();
    if (pid_ > 0) {
        kill(pid_, SIGKILL); /* alive but silent is as good as dead */
        reap();
    }
    ++restarts_;
    greeted_ = false;
    start();
}

/* After a failure: only so often without an answer between. */
void SinkProcess::recover()
{
    if (++failures_ > kFailuresMax || silences_ >= kSilencesMax) {
        std::error_code ignored;
        const bool said = std::filesystem::file_size(options_.log, ignored) > 0 && !ignored;
        throw InputError(options_.program.string(), "run",
                         "does not answer" + (said ? "; " + options_.log.string() + " may say why" : ""));
    }
    restart();
}

void SinkProcess::finish()
{
    for (;;) {
        disconnect(); /* it exports and ends */
        const int status = reap();
        if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
            return;
        }
        recover();
    }
}

} // namespace tsr

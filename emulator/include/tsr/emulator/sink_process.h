/*
 * The sink of an emulation: a real tarsier-sink process at the other end of a
 * socket, spoken to in lockstep. It ends with this process, however that ends.
 *
 * Virtual time stands still while a request waits for its answer, so the run
 * does not depend on how fast the sink is. If the process dies it is started
 * again, and what it had not answered is asked again: the gateway link's own
 * rule for a lost connection.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_SINK_PROCESS_H
#define TSR_EMULATOR_SINK_PROCESS_H

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <sys/types.h>

#include "tsr/emulator/sink_link.h"

namespace tsr
{

class SinkProcess : public SinkLink
{
  public:
    struct Options {
        std::filesystem::path program; /* tarsier-sink */
        std::filesystem::path site;
        std::filesystem::path keys;
        std::filesystem::path database;
        std::filesystem::path out;
        std::filesystem::path log; /* its stdout and stderr */
        /* An end of the run is asked for: an answer is not waited for as long then. */
        std::function<bool()> stopping = [] { return false; };
    };

    /* Starts the process. Throws InputError if it cannot be run. */
    explicit SinkProcess(Options options);
    ~SinkProcess() override;
    SinkProcess(const SinkProcess &) = delete;
    SinkProcess &operator=(const SinkProcess &) = delete;

    /* Send one encoded link frame; returns the bytes of its ANSWER. Throws
     * InputError if the sink refuses its input or cannot be kept alive. */
    std::vector<std::uint8_t> exchange(const std::uint8_t *frame, std::size_t len) override;

    void restart() override;

    /* Let it export and end; checks its exit status. */
    void finish();

    unsigned restarts() const { return restarts_; }

  private:
    void start();
    void recover();
    bool send_all(const std::uint8_t *bytes, std::size_t len);
    bool is_readable();
    bool read_answer(std::uint16_t sequence);
    bool ask(const std::uint8_t *frame, std::size_t len);
    void disconnect();
    int reap();

    Options options_;
    std::vector<std::uint8_t> hello_;  /* the gateway's HELLO, first on every connection */
    std::vector<std::uint8_t> answer_; /* to the last frame that had one */
    bool greeted_ = false;             /* this process has had it */
    int socket_ = -1;
    pid_t pid_ = -1;
    unsigned restarts_ = 0;
    unsigned failures_ = 0; /* since the last answer */
    unsigned silences_ = 0; /* of them those of a process that lives */
};

} // namespace tsr

#endif

/*
 * Virtual time: a queue of events, run in order of time and, at one instant,
 * in the order they were asked for. Nothing in a run depends on anything else.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_EVENT_QUEUE_H
#define TSR_EMULATOR_EVENT_QUEUE_H

#include <cstddef>
#include <cstdint>
#include <functional>
#include <queue>
#include <vector>

namespace tsr
{

class EventQueue
{
  public:
    using Action = std::function<void()>;

    std::uint64_t now_us() const { return now_us_; }
    bool empty() const { return events_.empty(); }
    std::uint64_t next_us() const { return events_.top().time_us; }

    /* Run action at time_us; a time in the past means now. */
    void at(std::uint64_t time_us, Action action);
    /* Advance to the next event and run it. The queue must not be empty. */
    void run_next();

  private:
    struct Event {
        std::uint64_t time_us;
        std::uint64_t number;
        std::size_t action; /* its place in actions_, so that a heap of events moves little */
        bool operator<(const Event &other) const
        { /* the greatest is run first */
            return time_us != other.time_us ? time_us > other.time_us : number > other.number;
        }
    };

    std::priority_queue<Event> events_;
    std::vector<Action> actions_;
    std::vector<std::size_t> free_; /* places in actions_ */
    std::uint64_t now_us_ = 0;
    std::uint64_t numbers_ = 0;
};

} // namespace tsr

#endif

/*
 * The event queue of virtual time.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/emulator/event_queue.h"

#include <algorithm>
#include <utility>

namespace tsr
{

void EventQueue::at(std::uint64_t time_us, Action action)
{
    std::size_t place = actions_.size();
    if (free_.empty()) {
        actions_.push_back(std::move(action));
    } else {
        place = free_.back();
        free_.pop_back();
        actions_[place] = std::move(action);
    }
    events_.push({std::max(time_us, now_us_), numbers_++, place});
}

void EventQueue::run_next()
{
    const Event event = events_.top();
    events_.pop();
    now_us_ = event.time_us;
    Action action = std::move(actions_[event.action]);
    actions_[event.action] = nullptr;
    free_.push_back(event.action);
    action();
}

} // namespace tsr

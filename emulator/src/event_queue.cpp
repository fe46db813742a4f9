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
    events_.push({std::max(time_us, now_us_), numbers_++, std::move(action)});
}

void EventQueue::run_next()
{
    /* top() is const because changing it could break the order; it is popped
     * at once, so moving its action out is safe. */
    Action action = std::move(const_cast<Event &>(events_.top()).action);
    now_us_ = events_.top().time_us;
    events_.pop();
    action();
}

} // namespace tsr

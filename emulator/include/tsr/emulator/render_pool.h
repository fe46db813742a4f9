/*
 * Threads that render virtual cameras while virtual time goes on.
 *
 * What a camera shows follows from the scene and the time alone, so the number
 * of threads changes nothing but how long a run takes.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_RENDER_POOL_H
#define TSR_EMULATOR_RENDER_POOL_H

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <future>
#include <mutex>
#include <thread>
#include <vector>

#include "tsr/scenario/virtual_camera.h"

namespace tsr
{

class RenderPool
{
  public:
    /* geometry is kept; threads >= 1. */
    RenderPool(const scene::Geometry &geometry, unsigned threads);
    ~RenderPool(); /* what was not begun is dropped */
    RenderPool(const RenderPool &) = delete;
    RenderPool &operator=(const RenderPool &) = delete;

    /* Render camera, which is kept until the result is there, for time_us. One at a time of each camera. */
    std::future<void> render(VirtualCamera &camera, std::uint64_t time_us);

  private:
    using Job = std::packaged_task<void(scene::RayCaster &)>;
    void work();

    const scene::Geometry &geometry_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Job> jobs_;
    bool ends_ = false;
    std::vector<std::thread> threads_;
};

} // namespace tsr

#endif

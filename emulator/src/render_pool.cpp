/*
 * A queue of pictures to render.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/emulator/render_pool.h"

namespace tsr
{

RenderPool::RenderPool(const scene::Geometry &geometry, unsigned threads) : geometry_(geometry)
{
    for (unsigned i = 0; i < threads; ++i) {
        threads_.emplace_back([this] { work(); });
    }
}

RenderPool::~RenderPool()
{
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
        jobs_.clear();
    }
    changed_.notify_all();
    for (std::thread &thread : threads_) {
        thread.join();
    }
}

std::future<void> RenderPool::render(VirtualCamera &camera, std::uint64_t time_us)
{
    Job job([&camera, time_us](scene::RayCaster &caster) { camera.render(caster, time_us); });
    auto result = job.get_future();
    {
        const std::lock_guard lock(mutex_);
        jobs_.push_back(std::move(job));
    }
    changed_.notify_one();
    return result;
}

void RenderPool::work()
{
    scene::RayCaster caster(geometry_);
    for (;;) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return ends_ || !jobs_.empty(); });
        if (ends_) {
            return;
        }
        Job job = std::move(jobs_.front());
        jobs_.pop_front();
        lock.unlock();
        job(caster);
    }
}

} // namespace tsr

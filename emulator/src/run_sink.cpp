/* Sinks of a run. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/emulator/run_sink.h"

#include <algorithm>
#include <iterator>

#include "tsr/emulator/jpeg_sink.h"
#include "tsr/emulator/sink_process.h"
#include "tsr/host/ply.h"

namespace tsr
{

namespace
{

class MapSink : public RunSink
{
  public:
    MapSink(const std::filesystem::path &program, const Site &site, const OutFolder &out)
        : site_(site), out_(out.path()), process_({program, out.file("site.toml"), out.file("keys.toml"),
                                                   out.file("sink.db"), out.path(), out.file("sink.log")})
    {
    }

    SinkLink &link() override { return process_; }
    void finish() override { process_.finish(); }
    std::vector<ReceivedMap> maps(const Simulation &simulation, Pictures &pictures) override
    {
        return read_received_maps(site_, simulation, pictures, out_);
    }
    std::vector<ReceivedEvent> events(const Simulation &simulation) override
    {
        return read_received_events(simulation, out_);
    }
    unsigned restarts() const override { return process_.restarts(); }

  private:
    const Site &site_;
    std::filesystem::path out_;
    SinkProcess process_;
};

constexpr const char *kPictures = "pictures";

class PictureSink : public RunSink
{
  public:
    PictureSink(const KeyRing &keys, const OutFolder &out)
        : cloud_(out.file("cloud.ply")), sink_(keys, out.file(kPictures))
    {
    }

    SinkLink &link() override { return sink_; }
    void finish() override { PlyWriter(cloud_, 0).complete(); }
    std::vector<ReceivedMap> maps(const Simulation &simulation, Pictures &) override
    {
        std::vector<ReceivedMap> maps;
        const auto as_map = [&](const JpegSink::Received &received) {
            ReceivedMap map;
            map.node = received.node;
            map.counter = received.counter;
            map.capture_time_us = simulation.virtual_us(received.node, received.capture_time_us);
            map.kept = true;
            map.map_bytes = received.right_bytes;
            map.reference_bytes = received.left_bytes;
            map.file = kPictures + ("/" + received.name);
            map.ending = "-left.jpg";
            return map;
        };
        std::transform(sink_.received().begin(), sink_.received().end(), std::back_inserter(maps), as_map);
        std::sort(maps.begin(), maps.end(), [](const ReceivedMap &a, const ReceivedMap &b) {
            return std::pair(a.node, a.counter) < std::pair(b.node, b.counter);
        });
        return maps;
    }
    std::vector<ReceivedEvent> events(const Simulation &) override { return {}; }
    unsigned restarts() const override { return sink_.restarts(); }

  private:
    std::filesystem::path cloud_;
    JpegSink sink_;
};

} // namespace

std::unique_ptr<RunSink> start_map_sink(const std::filesystem::path &program, const Site &site, const OutFolder &out)
{
    return std::make_unique<MapSink>(program, site, out);
}

std::unique_ptr<RunSink> start_jpeg_sink(const KeyRing &keys, const OutFolder &out)
{
    return std::make_unique<PictureSink>(keys, out);
}

} // namespace tsr

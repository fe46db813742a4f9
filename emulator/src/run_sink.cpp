/* Sinks of a run. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/emulator/run_sink.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>

#include <unistd.h>

#include "tsr/emulator/jpeg_sink.h"
#include "tsr/emulator/sink_process.h"
#include "tsr/host/input_error.h"
#include "tsr/host/ply.h"

namespace tsr
{

namespace
{

SinkProcess::Options options_of(const SinkProgram &sink, const UnfinishedRun &run)
{
    SinkProcess::Options options;
    options.program = sink.program;
    options.stopping = sink.stopping;
    options.site = run.file("site.toml");
    options.keys = run.file("keys.toml");
    options.database = run.file("sink.db");
    options.out = run.path();
    options.log = run.file("sink.log");
    return options;
}

class MapSink : public RunSink
{
  public:
    MapSink(const SinkProgram &sink, const Site &site, const UnfinishedRun &run)
        : site_(site), out_(run.path()), process_(options_of(sink, run))
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
    PictureSink(const KeyRing &keys, const UnfinishedRun &run)
        : cloud_(run.file("cloud.ply")), sink_(keys, run.file(kPictures))
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

void check_program(const std::filesystem::path &program)
{
    if (access(program.c_str(), X_OK) != 0) {
        throw InputError(program.string(), "run", std::strerror(errno));
    }
}

std::unique_ptr<RunSink> start_map_sink(const SinkProgram &sink, const Site &site, const UnfinishedRun &run)
{
    return std::make_unique<MapSink>(sink, site, run);
}

std::unique_ptr<RunSink> start_jpeg_sink(const KeyRing &keys, const UnfinishedRun &run)
{
    return std::make_unique<PictureSink>(keys, run);
}

} // namespace tsr

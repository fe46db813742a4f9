/*
 * The sink of a run with what it leaves in the run's folder: tarsier-sink as a
 * process, or the baseline's.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_RUN_SINK_H
#define TSR_EMULATOR_RUN_SINK_H

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "tsr/emulator/run_record.h"
#include "tsr/emulator/sink_link.h"
#include "tsr/emulator/unfinished_run.h"

namespace tsr
{

class RunSink
{
  public:
    virtual ~RunSink() = default;
    virtual SinkLink &link() = 0;
    /* After the run: all that it leaves is in the folder. Throws InputError. */
    virtual void finish() = 0;
    /* After finish(). Throw InputError. */
    virtual std::vector<ReceivedMap> maps(const Simulation &simulation, Pictures &pictures) = 0;
    virtual std::vector<ReceivedEvent> events(const Simulation &simulation) = 0;
    virtual unsigned restarts() const = 0;
};

struct SinkProgram {
    std::filesystem::path program;  /* tarsier-sink */
    std::function<bool()> stopping; /* an end of the run is asked for */
};

/* Throws InputError if it cannot be run. */
void check_program(const std::filesystem::path &program);

/* site.toml and keys.toml are in run; site, keys and run are kept. Throws InputError. */
std::unique_ptr<RunSink> start_map_sink(const SinkProgram &sink, const Site &site, const UnfinishedRun &run);
/* The files go to pictures/, and cloud.ply has no point. */
std::unique_ptr<RunSink> start_jpeg_sink(const KeyRing &keys, const UnfinishedRun &run);

} // namespace tsr

#endif

/* The faults of a run, for summary.json and the page. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/emulator/report.h"

namespace tsr
{

namespace
{

double seconds(std::uint64_t time_us)
{
    return static_cast<double>(time_us) / 1e6;
}

} // namespace

nlohmann::ordered_json faults_json(const Simulation &simulation)
{
    auto json = nlohmann::ordered_json::array();
    for (const FaultNote &note : simulation.faults().notes()) {
        const SiteFault &fault = note.fault;
        nlohmann::ordered_json entry{{"at_s", seconds(note.time_us)}, {"kind", fault_name(fault.kind)}};
        if (fault.node != kNodeNone) {
            entry["node"] = fault.node;
        }
        if (fault.other != kNodeNone) {
            entry["other"] = fault.other;
        }
        if (fault.for_us != 0) {
            entry["for_s"] = seconds(fault.for_us);
        }
        if (fault.kind == SiteFaultKind::clock_drift) {
            entry["ppm"] = fault.ppm;
        }
        if (fault.kind == SiteFaultKind::link_loss) {
            entry["loss_db"] = fault.loss_db;
            entry["frame_loss"] = fault.frame_loss;
        }
        if (fault.counter_start != 0) {
            entry["counter_start"] = fault.counter_start;
        }
        if (note.without_effect) {
            entry["without_effect"] = true;
        }
        json.push_back(std::move(entry));
    }
    return json;
}

} // namespace tsr

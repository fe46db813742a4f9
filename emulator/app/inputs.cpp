/* Looking where inputs lie. SPDX-License-Identifier: Apache-2.0 */
#include "inputs.h"

#include "tsr/host/paths.h"

namespace tsr::app
{

namespace
{

void refuse_frames(const OutFolder &out, const Site &site)
{
    const auto refuse = [&](const std::filesystem::path &folder) {
        if (!folder.empty()) {
            out.refuse_input(site.resolve(folder));
        }
    };
    for (const SiteNode &node : site.nodes) {
        refuse(node.frames);
        refuse(node.frames_right);
    }
    for (const SitePair &pair : site.pairs) {
        refuse(pair.truth);
    }
}

/* What a crowd sees. */
void refuse_recorded(const OutFolder &out, const Site &recorded)
{
    out.refuse_input(recorded.file);
    refuse_frames(out, recorded);
}

} // namespace

void refuse_inputs_of_run(const OutFolder &out, const Options &options, const Site &site,
                          const StagedScenario *scenario)
{
    const auto own = out.file(scenario != nullptr ? "scenario.toml" : "site.toml");
    if (!options.site.empty() && real_path(options.site) != real_path(own)) {
        out.refuse_input(options.site);
    }
    refuse_frames(out, site);
    if (scenario != nullptr && scenario->recorded() != nullptr) {
        refuse_recorded(out, *scenario->recorded());
    }
}

void refuse_inputs_of_sweep(const OutFolder &out, const Options &options, const std::vector<Site> &recorded)
{
    out.refuse_input(options.site);
    for (const Site &site : recorded) {
        refuse_recorded(out, site);
    }
}

} // namespace tsr::app

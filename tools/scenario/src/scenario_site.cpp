/* What a scenario says of its site. SPDX-License-Identifier: Apache-2.0 */
#include "scenario_site.h"

namespace tsr
{

Site site_of(const Scenario &scenario)
{
    Site site;
    site.file = scenario.file;
    site.name = scenario.name;
    site.seed = scenario.seed;
    site.radio = scenario.radio;
    site.thresholds = scenario.thresholds;
    site.battery = scenario.battery;
    site.faults = scenario.faults;
    return site;
}

} // namespace tsr

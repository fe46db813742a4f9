/* Names of causes. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/sink/tally.h"

namespace tsr
{
namespace
{

constexpr std::array<std::string_view, static_cast<std::size_t>(Cause::cause_count)> kNames{
    "link_damaged",   "link_unexpected", "hello_refused",    "fragment_format",      "other_destination",
    "unknown_node",   "no_key",          "message_too_long", "fragment_contradicts", "message_abandoned",
    "message_format", "not_authentic",   "body_format",      "map_format",           "reference_format",
    "no_pair",        "other_settings",  "counter_reused",   "store_failed"};
static_assert(!kNames.back().empty());

} // namespace

std::string_view cause_name(Cause cause)
{
    return kNames.at(static_cast<std::size_t>(cause));
}

} // namespace tsr

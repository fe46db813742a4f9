/* [[fault]] tables: which fields belong to which kind. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/fault.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "site_faults.h"
#include "tsr/host/site_fields.h"

namespace tsr
{
namespace
{

enum class Lasts {
    no,
    perhaps, /* without for_s: for ever, a restart: no time at all */
    yes
};

struct Rule {
    SiteFaultKind kind;
    const char *name;
    bool node;
    Lasts lasts;
};

constexpr std::array kRules = {
    Rule{SiteFaultKind::death, "death", true, Lasts::no},
    Rule{SiteFaultKind::reboot, "reboot", true, Lasts::no},
    Rule{SiteFaultKind::brown_out, "brown-out", true, Lasts::yes},
    Rule{SiteFaultKind::clock_drift, "clock drift", true, Lasts::perhaps},
    Rule{SiteFaultKind::link_loss, "link loss", true, Lasts::perhaps},
    Rule{SiteFaultKind::camera_failure, "camera failure", true, Lasts::perhaps},
    Rule{SiteFaultKind::gateway_restart, "gateway restart", false, Lasts::perhaps},
    Rule{SiteFaultKind::sink_restart, "sink restart", false, Lasts::no},
};

const Rule &rule_of(SiteFaultKind kind)
{
    return *std::find_if(kRules.begin(), kRules.end(), [kind](const Rule &rule) { return rule.kind == kind; });
}

const Rule &read_kind(TomlFields &fields)
{
    const std::string text = fields.string("kind");
    const auto *found = std::find_if(kRules.begin(), kRules.end(), [&](const Rule &rule) { return text == rule.name; });
    if (found != kRules.end()) {
        return *found;
    }
    std::string known;
    for (const Rule &rule : kRules) {
        known += (known.empty() ? "" : ", ") + std::string(rule.name);
    }
    fields.refuse("kind", "'" + text + "' is none of " + known);
}

std::uint64_t read_time(TomlFields &fields, std::string_view field, std::optional<double> fallback = {})
{
    const double seconds = fields.number(field, 0, static_cast<double>(kFaultTimeUsMax) / 1e6, fallback);
    return static_cast<std::uint64_t>(std::llround(seconds * 1e6));
}

void read_duration(TomlFields &fields, const Rule &rule, SiteFault &fault)
{
    if (rule.lasts == Lasts::no) {
        return;
    }
    fault.for_us = read_time(fields, "for_s", rule.lasts == Lasts::yes ? std::nullopt : std::optional<double>(0));
    if (rule.lasts == Lasts::yes && fault.for_us == 0) {
        fields.refuse("for_s", "is not above 0; a node that is off for no time has a reboot");
    }
}

/* Of the fields that only some kinds have. Those of other kinds are left to be refused. */
void read_details(TomlFields &fields, SiteFault &fault)
{
    if (fault.kind == SiteFaultKind::clock_drift) {
        fault.ppm = static_cast<int>(fields.integer("ppm", -kDriftPpmMax, kDriftPpmMax));
        if (fault.ppm == 0) {
            fields.refuse("ppm", "0 is no drift");
        }
    }
    if (fault.kind == SiteFaultKind::link_loss) {
        fault.other = static_cast<std::uint16_t>(fields.integer("other", 1, kNodeIdMax, kNodeNone));
        fault.frame_loss = fields.number("frame_loss", 0, 1, 0);
        /* A part of the frames alone leaves the levels as they are. */
        fault.loss_db = fields.number("loss_db", 0, kLinkLossDbMax, fields.has("frame_loss") ? 0 : kLinkLossDbMax);
        if (fault.loss_db == 0 && fault.frame_loss == 0) {
            fields.refuse(fields.has("loss_db") ? "loss_db" : "frame_loss", "0 loses nothing");
        }
    }
    if (is_restart(fault.kind)) {
        fault.counter_start = static_cast<std::uint32_t>(
            fields.integer("counter_start", 0, std::numeric_limits<std::uint32_t>::max(), 0));
    }
}

/* A field of another kind is no typing error: say whose it is not. */
void refuse_others(const TomlFields &fields, const Rule &rule)
{
    const bool restart = is_restart(rule.kind), link = rule.kind == SiteFaultKind::link_loss;
    const std::array<std::pair<const char *, bool>, 7> takes = {{{"node", rule.node},
                                                                 {"for_s", rule.lasts != Lasts::no},
                                                                 {"ppm", rule.kind == SiteFaultKind::clock_drift},
                                                                 {"other", link},
                                                                 {"loss_db", link},
                                                                 {"frame_loss", link},
                                                                 {"counter_start", restart}}};
    for (const auto &[field, taken] : takes) {
        if (!taken && fields.has(field)) {
            fields.refuse(field, "does not belong to a " + std::string(rule.name));
        }
    }
    fields.refuse_unknown();
}

[[noreturn]] void refuse_fault(const Site &site, std::size_t index, const std::string &field, const std::string &reason)
{
    refuse_site(site, site.faults[index].line, "fault " + std::to_string(index + 1) + ": " + field, reason);
}

void check_numbers(const Site &site, std::size_t index)
{
    const SiteFault &fault = site.faults[index];
    if (fault.at_us > kFaultTimeUsMax || fault.for_us > kFaultTimeUsMax) {
        refuse_fault(site, index, fault.at_us > kFaultTimeUsMax ? "at_s" : "for_s", "is more than a year");
    }
    if (fault.ppm < -kDriftPpmMax || fault.ppm > kDriftPpmMax) {
        refuse_fault(site, index, "ppm", "is outside -1000..1000");
    }
    if (!(fault.loss_db >= 0 && fault.loss_db <= kLinkLossDbMax)) {
        refuse_fault(site, index, "loss_db", "is outside 0..200");
    }
    if (!(fault.frame_loss >= 0 && fault.frame_loss <= 1)) {
        refuse_fault(site, index, "frame_loss", "is outside 0..1");
    }
}

void check_nodes(const Site &site, std::size_t index)
{
    const SiteFault &fault = site.faults[index];
    const SiteNode *node = site.node(fault.node);
    if (node == nullptr) {
        refuse_fault(site, index, "node", "there is no node " + std::to_string(fault.node));
    }
    const std::string named = "node " + std::to_string(fault.node);
    if (fault.kind == SiteFaultKind::camera_failure && !has_camera(node->role)) {
        refuse_fault(site, index, "node", named + " is a " + std::string(role_name(node->role)) + " without a camera");
    }
    if (fault.other != kNodeNone && site.node(fault.other) == nullptr) {
        refuse_fault(site, index, "other", "there is no node " + std::to_string(fault.other));
    }
    if (fault.other != kNodeNone && fault.other == fault.node) {
        refuse_fault(site, index, "other", named + " has no link with itself");
    }
}

/* The node a fault is about; the sink is none. */
std::uint16_t struck_node(const Site &site, const SiteFault &fault)
{
    return fault.kind == SiteFaultKind::gateway_restart ? site.gateway().id : fault.node;
}

/* What is dead cannot fail; at one instant the file's order counts. */
void check_alive(const Site &site, std::size_t index)
{
    const SiteFault &fault = site.faults[index];
    for (std::size_t i = 0; i < site.faults.size(); i++) {
        const SiteFault &death = site.faults[i];
        const bool before = death.at_us < fault.at_us || (death.at_us == fault.at_us && i < index);
        if (death.kind == SiteFaultKind::death && before && fault.kind != SiteFaultKind::sink_restart &&
            struck_node(site, death) == struck_node(site, fault)) {
            refuse_fault(site, index, "at_s",
                         "node " + std::to_string(death.node) + " is dead since fault " + std::to_string(i + 1));
        }
    }
}

} // namespace

std::string_view fault_name(SiteFaultKind kind)
{
    return rule_of(kind).name;
}

bool is_restart(SiteFaultKind kind)
{
    return kind == SiteFaultKind::reboot || kind == SiteFaultKind::brown_out || kind == SiteFaultKind::gateway_restart;
}

std::vector<SiteFault> read_faults(TomlFields &top)
{
    std::vector<SiteFault> faults;
    for (TomlFields &fields : top.tables("fault")) {
        SiteFault fault;
        fault.line = fields.line();
        const Rule &rule = read_kind(fields);
        fault.kind = rule.kind;
        fault.at_us = read_time(fields, "at_s");
        if (rule.node) {
            fault.node = static_cast<std::uint16_t>(fields.integer("node", 1, kNodeIdMax));
        }
        read_duration(fields, rule, fault);
        read_details(fields, fault);
        refuse_others(fields, rule);
        faults.push_back(fault);
    }
    return faults;
}

void check_faults(const Site &site)
{
    for (std::size_t i = 0; i < site.faults.size(); i++) {
        check_numbers(site, i);
        if (rule_of(site.faults[i].kind).node) {
            check_nodes(site, i);
        }
        check_alive(site, i);
    }
}

} // namespace tsr

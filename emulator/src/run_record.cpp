/*
 * Gathering what a run gave.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/emulator/run_record.h"

#include <algorithm>
#include <cmath>

namespace tsr
{

namespace
{

/* IEEE 802.15.4-2020, 12.1: preamble, SFD and PHR before the PSDU; 250 kbit/s. */
constexpr std::uint64_t kPhyHeaderLen = 6;
constexpr std::uint64_t kOctetUs = 32;

int hops_of(const Site &site, const SiteNode &node)
{
    int hops = 0;
    for (const SiteNode *at = &node; at != nullptr && at->parent != kNodeNone; at = site.node(at->parent)) {
        ++hops;
    }
    return hops;
}

/* Time on air of what each node got of the frames for it. */
std::map<std::uint16_t, std::uint64_t> times_heard_us(const Traffic &traffic)
{
    std::map<std::uint16_t, std::uint64_t> times;
    for (const auto &[ends, tally] : traffic.links()) {
        times[ends.second] += (tally.received_bytes + tally.received * kPhyHeaderLen) * kOctetUs;
    }
    return times;
}

std::vector<NodeRecord> gather_nodes(const Site &site, const Simulation &simulation,
                                     const std::vector<ReceivedMap> &maps)
{
    std::map<std::uint16_t, std::size_t> received;
    for (const ReceivedMap &map : maps) {
        ++received[map.node];
    }
    std::map<std::uint16_t, const SitePair *> pairs;
    for (const SitePair &pair : site.pairs) {
        pairs[pair.lead] = &pair;
        if (pair.wing != kNodeNone) {
            pairs[pair.wing] = &pair;
        }
    }
    auto heard_us = times_heard_us(simulation.traffic());
    std::vector<NodeRecord> nodes;
    for (std::size_t i = 0; i < simulation.nodes().size(); ++i) {
        const EmulatedNode &node = *simulation.nodes()[i];
        NodeRecord record;
        record.site = &node.site_node();
        record.pair = pairs[node.id()];
        record.hops = hops_of(site, node.site_node());
        record.lives = node.lives();
        record.counters = node.counters();
        record.mac = node.mac_counters();
        record.sender = node.sender_counters();
        record.air = simulation.air_tally(i);
        record.energy = node.energy();
        record.active_mj = node.active_mj(heard_us[node.id()]);
        record.powered_us = node.times().total_us;
        record.mean_uw =
            record.powered_us > 0 ? record.energy.total() / static_cast<double>(record.powered_us) * 1e9 : 0;
        record.life = battery_life(site.battery, record.mean_uw);
        record.work_units = node.work_units();
        record.arena_len = node.arena_len();
        record.maps_received = received[node.id()];
        nodes.push_back(record);
    }
    return nodes;
}

std::vector<LinkRecord> gather_links(const Simulation &simulation, const std::vector<NodeRecord> &nodes)
{
    std::map<std::uint16_t, std::size_t> places;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        places[nodes[i].site->id] = i;
    }
    std::vector<LinkRecord> links;
    for (const auto &[ends, tally] : simulation.traffic().links()) {
        const auto from = places.find(ends.first);
        const auto to = places.find(ends.second);
        LinkRecord link{ends.first, ends.second, 0, tally, Air::kSilentDbm, 0};
        if (from != places.end() && to != places.end()) {
            link.hops = std::max(nodes[from->second].hops, nodes[to->second].hops);
            link.rssi_dbm = simulation.air().rssi_dbm(simulation.nodes()[from->second]->radio_index(),
                                                      simulation.nodes()[to->second]->radio_index());
        }
        link.snr_db = link.rssi_dbm - simulation.air().noise_dbm();
        links.push_back(link);
    }
    return links;
}

/* The commit of a map or an event is the first of its message after its capture. */
template <typename Received> void find_commits(std::vector<Received> &received, const std::vector<Commit> &commits)
{
    std::map<std::pair<std::uint16_t, std::uint16_t>, std::vector<std::uint64_t>> times;
    for (const Commit &commit : commits) {
        times[{commit.node, commit.message_id}].push_back(commit.time_us);
    }
    for (Received &one : received) {
        const auto found = times.find({one.node, static_cast<std::uint16_t>(one.counter)});
        if (found != times.end()) {
            const auto after = std::lower_bound(found->second.begin(), found->second.end(), one.capture_time_us);
            if (after != found->second.end()) {
                one.commit_time_us = *after;
            }
        }
    }
}

Fate fate_of(const PhaseChange &end, Role role, bool committed)
{
    if (role == Role::wing) {
        return end.before == TSR_PHASE_SENDING ? Fate::view : Fate::failed;
    }
    switch (end.before) {
    case TSR_PHASE_MEDIAN: /* with an EVENT unanswered there is nothing to measure against */
    case TSR_PHASE_MEASURING: return Fate::measured;
    case TSR_PHASE_COMPARING: return Fate::withheld;
    case TSR_PHASE_SEALING: /* it goes on watching: settle_sealed() finds what becomes of its map */
    case TSR_PHASE_SENDING: return committed ? Fate::committed : Fate::lost;
    default: return Fate::failed;
    }
}

/* A node that goes on watching while its map is under way: it is committed later, but before its next one is coded. */
void settle_sealed(std::vector<Episode> &episodes, const std::vector<bool> &sealed,
                   const std::map<std::uint16_t, std::vector<std::uint64_t>> &commits)
{
    std::map<std::uint16_t, std::uint64_t> next_us;
    for (std::size_t i = episodes.size(); i-- > 0;) {
        if (!sealed[i]) {
            continue;
        }
        Episode &episode = episodes[i];
        const auto times = commits.find(episode.node);
        const std::uint64_t end_us = next_us.try_emplace(episode.node, UINT64_MAX).first->second;
        if (times != commits.end()) {
            const auto commit = std::lower_bound(times->second.begin(), times->second.end(), episode.from_us);
            episode.fate = commit != times->second.end() && *commit < end_us ? Fate::committed : Fate::lost;
        }
        next_us[episode.node] = episode.until_us;
    }
}

std::vector<Episode> gather_episodes(const Simulation &simulation, const std::vector<NodeRecord> &nodes)
{
    std::map<std::uint16_t, Role> roles;
    for (const NodeRecord &node : nodes) {
        roles[node.site->id] = node.site->role;
    }
    std::map<std::uint16_t, std::vector<std::uint64_t>> commits;
    for (const Commit &commit : simulation.traffic().commits()) {
        if (commit.kind == message_index(TSR_MESSAGE_MAP)) {
            commits[commit.node].push_back(commit.time_us);
        }
    }
    std::vector<Episode> episodes;
    std::vector<bool> sealed;
    std::map<std::uint16_t, std::uint64_t> begun;
    for (const PhaseChange &change : simulation.timeline()) {
        if (change.phase > TSR_PHASE_WATCHING) {
            begun.try_emplace(change.node, change.time_us);
            continue;
        }
        const auto start = begun.find(change.node);
        if (start != begun.end()) {
            const auto &times = commits[change.node];
            const auto commit = std::lower_bound(times.begin(), times.end(), start->second);
            const bool committed = commit != times.end() && *commit <= change.time_us;
            episodes.push_back(
                {change.node, start->second, change.time_us, fate_of(change, roles.at(change.node), committed)});
            sealed.push_back(change.before == TSR_PHASE_SEALING);
            begun.erase(start);
        }
    }
    settle_sealed(episodes, sealed, commits);
    for (const auto &[node, from_us] : begun) {
        episodes.push_back({node, from_us, simulation.duration_us(), Fate::under_way});
    }
    return episodes;
}

double median_of(std::vector<double> &values)
{
    return quantiles_of(values).median;
}

void digest_maps(RunDigest &digest, const std::vector<ReceivedMap> &maps)
{
    std::vector<double> latency;
    std::vector<double> error_px;
    std::vector<double> error_mm;
    std::vector<double> correct;
    for (const ReceivedMap &map : maps) {
        if (const auto latency_s = map.latency_s()) {
            latency.push_back(*latency_s);
        }
        if (map.error) {
            if (map.error->median_px) {
                error_px.push_back(*map.error->median_px);
            }
            if (map.error->median_mm) {
                error_mm.push_back(*map.error->median_mm);
            }
            correct.push_back(map.error->correct);
        }
    }
    digest.latency_s = quantiles_of(latency);
    digest.error_px = quantiles_of(error_px);
    digest.error_mm = quantiles_of(error_mm);
    if (!correct.empty()) {
        digest.correct = median_of(correct);
    }
}

void digest_energy(RunDigest &digest, const std::vector<NodeRecord> &nodes, std::size_t maps)
{
    for (const NodeRecord &node : nodes) {
        digest.active_mj += node.active_mj;
    }
    digest.active_mj_per_map = maps > 0 ? digest.active_mj / static_cast<double>(maps) : 0;
}

void digest_lives(RunDigest &digest, const std::vector<NodeRecord> &nodes)
{
    std::vector<double> lives;
    for (const NodeRecord &node : nodes) {
        if (node.site->role == Role::gateway || node.powered_us == 0) {
            continue;
        }
        if (digest.shortest_life == kNodeNone || node.life.days < digest.shortest_life_days) {
            digest.shortest_life = node.site->id;
            digest.shortest_life_days = node.life.days;
        }
        lives.push_back(node.life.days);
    }
    digest.median_life_days = median_of(lives);
}

void digest_traffic(RunDigest &digest, const std::vector<LinkRecord> &links)
{
    const auto add = [&](std::size_t kind, int hops, const FrameTally &tally) {
        if (tally.frames > 0) {
            FrameTally &sum = digest.traffic[{kind, hops}];
            sum.frames += tally.frames;
            sum.bytes += tally.bytes;
        }
    };
    for (const LinkRecord &link : links) {
        for (std::size_t kind = 0; kind < link.tally.kinds.size(); ++kind) {
            add(kind, link.hops, link.tally.kinds.at(kind));
        }
        add(link.tally.kinds.size(), link.hops, link.tally.acknowledgements);
    }
}

} // namespace

std::optional<double> ReceivedMap::latency_s() const
{
    return commit_time_us ? std::optional(static_cast<double>(*commit_time_us - capture_time_us) / 1e6) : std::nullopt;
}

const char *fate_name(Fate fate)
{
    switch (fate) {
    case Fate::committed: return "committed";
    case Fate::withheld: return "withheld";
    case Fate::measured: return "measured";
    case Fate::lost: return "lost";
    case Fate::failed: return "failed";
    case Fate::view: return "view";
    case Fate::under_way: return "under way";
    }
    return "";
}

Quantiles quantiles_of(std::vector<double> &values)
{
    if (values.empty()) {
        return {};
    }
    std::sort(values.begin(), values.end());
    const auto rank = [&](std::size_t percent) { return values[(values.size() * percent + 99) / 100 - 1]; };
    return {values.size(), rank(50), rank(95), values.back()};
}

const NodeRecord *RunRecord::node(std::uint16_t id) const
{
    const auto found =
        std::find_if(nodes.begin(), nodes.end(), [id](const NodeRecord &node) { return node.site->id == id; });
    return found == nodes.end() ? nullptr : &*found;
}

RunRecord gather(const Site &site, const Simulation &simulation, const Pictures &pictures,
                 std::vector<ReceivedMap> maps, std::vector<ReceivedEvent> zone_events)
{
    RunRecord record;
    record.site = &site;
    record.simulation = &simulation;
    record.nodes = gather_nodes(site, simulation, maps);
    record.links = gather_links(simulation, record.nodes);
    find_commits(maps, simulation.traffic().commits());
    record.maps = std::move(maps);
    record.zone_events = std::move(zone_events);
    find_commits(record.zone_events, simulation.traffic().commits());
    record.episodes = gather_episodes(simulation, record.nodes);
    record.events = pictures.events();
    digest_maps(record.digest, record.maps);
    digest_energy(record.digest, record.nodes, record.maps.size());
    digest_lives(record.digest, record.nodes);
    digest_traffic(record.digest, record.links);
    return record;
}

} // namespace tsr

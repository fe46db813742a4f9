/* From fragments to stored maps and events. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/sink/receiver.h"

#include <algorithm>
#include <stdexcept>

#include "event_message.h"
#include "map_message.h"
#include "tsr/host/aes.h"
#include "tsr/host/sink_answer.h"

extern "C" {
#include "tsr/wire/address.h"
}

namespace tsr
{
namespace
{

constexpr std::size_t kMessageLenMax = TSR_CCM_TEXT_MAX + TSR_MESSAGE_OVERHEAD_LEN;
constexpr std::size_t kFinishedMax = 16; /* messages a node may still be asking about */

tsr_body_status whole_status(std::uint16_t message_id, tsr_delivery state)
{
    tsr_body_status status{};
    status.message_id = message_id;
    status.state = static_cast<std::uint8_t>(state);
    return status;
}

} // namespace

Receiver::Receiver(const Site &site, const KeyRing &keys, Store &store)
    : site_(site), store_(store), selector_(site.thresholds, store)
{
    for (const SiteNode &node : site.nodes) {
        const std::optional<Key> key = keys.node_key(node.id);
        if (!key) {
            continue; /* its fragments count as no_key */
        }
        Origin &origin = origins_[node.id];
        if (tsr_cipher_init(&origin.cipher, &mbedtls_aes_ops(), key->data()) != TSR_OK) {
            throw std::runtime_error("Mbed TLS cannot expand a key");
        }
        if (node.role == Role::lead || node.role == Role::binocular) {
            origin.pair = site.pair_of(node.id);
        }
        remember_stored(origin, node.id);
    }
}

void Receiver::remember_stored(Origin &origin, std::uint16_t node) const
{
    origin.finished.clear();
    for (const std::uint32_t counter : store_.newest_counters(node, kFinishedMax)) {
        origin.finished.push_back({static_cast<std::uint16_t>(counter), TSR_DELIVERY_COMMITTED});
    }
}

std::vector<std::vector<std::uint8_t>> Receiver::receive(std::span<const std::vector<std::uint8_t>> fragments)
{
    std::vector<Verdict> verdicts;
    verdicts.reserve(fragments.size());
    for (const std::vector<std::uint8_t> &fragment : fragments) {
        verdicts.push_back(judge_fragment(fragment));
    }
    const bool on_disk = commit(verdicts);
    std::vector<std::vector<std::uint8_t>> answers(fragments.size());
    for (std::size_t i = 0; i < verdicts.size(); i++) {
        const Verdict &verdict = verdicts[i];
        if (verdict.status && (on_disk || !verdict.stored)) {
            try {
                answers[i] = status_fragment(origins_.at(verdict.node).cipher, verdict.node,
                                             store_.take_sealing_counter(), *verdict.status);
            } catch (const StoreError &) {
                tally_.add(Cause::store_failed); /* no counter, no answer */
            }
        }
        if (verdict.report && on_disk && report_) {
            report_(*verdict.report);
        }
        if (verdict.events && on_disk && report_events_) {
            report_events_(*verdict.events);
        }
    }
    return answers;
}

/* True: everything this batch stored is on disk. */
bool Receiver::commit(std::vector<Verdict> &verdicts)
{
    if (!in_transaction_) {
        return true;
    }
    in_transaction_ = false;
    try {
        store_.commit();
        return true;
    } catch (const StoreError &) {
        store_.rollback();
    }
    selector_.reload();
    for (const Verdict &verdict : verdicts) {
        if (verdict.stored) {
            tally_.add(Cause::store_failed);
            origins_.at(verdict.node).finished.clear(); /* the store still knows what it has */
        }
    }
    return false;
}

Receiver::Verdict Receiver::judge_fragment(const std::vector<std::uint8_t> &bytes)
{
    tsr_fragment fragment{};
    if (tsr_fragment_read(bytes.data(), bytes.size(), &fragment) != TSR_OK) {
        tally_.add(Cause::fragment_format);
        return {};
    }
    if (fragment.destination != TSR_ADDRESS_SINK) {
        tally_.add(Cause::other_destination);
        return {};
    }
    const auto found = origins_.find(fragment.origin);
    if (found == origins_.end()) {
        tally_.add(site_.node(fragment.origin) == nullptr ? Cause::unknown_node : Cause::no_key);
        return {};
    }
    Origin &origin = found->second;
    Verdict verdict;
    verdict.node = fragment.origin;
    const auto finished = std::find_if(origin.finished.begin(), origin.finished.end(),
                                       [&](const Finished &entry) { return entry.message_id == fragment.message_id; });
    if (finished != origin.finished.end()) {
        repeated_++;
        if (fragment.poll) {
            verdict.status = whole_status(finished->message_id, finished->state);
            /* Part of this very batch, perhaps: then the commit below decides. */
            verdict.stored = in_transaction_ && finished->state == TSR_DELIVERY_COMMITTED;
        }
        return verdict;
    }
    Assembly *assembly = assembly_for(origin, fragment);
    if (assembly == nullptr) {
        tally_.add(Cause::message_too_long);
        return {};
    }
    const tsr_status added = tsr_reassembly_add(&assembly->state, &fragment);
    if (added == TSR_OK) {
        return finish(origin, *assembly, fragment);
    }
    if (added != TSR_AGAIN) {
        tally_.add(Cause::fragment_contradicts);
        return {};
    }
    if (fragment.poll) {
        verdict.status = tsr_body_status_of(&assembly->state, TSR_DELIVERY_COMMITTED);
    }
    return verdict;
}

/* The message the fragment belongs to, begun if it is new; null if no message can be that long. */
Receiver::Assembly *Receiver::assembly_for(Origin &origin, const tsr_fragment &fragment)
{
    clock_++;
    for (Assembly &assembly : origin.assemblies) {
        if (tsr_reassembly_matches(&assembly.state, &fragment)) {
            assembly.last_use = clock_;
            return &assembly;
        }
    }
    const std::size_t len = std::size_t{fragment.count} * TSR_FRAGMENT_PIECE_MAX;
    if (len - TSR_FRAGMENT_PIECE_MAX + 1 > kMessageLenMax) {
        return nullptr;
    }
    Assembly &oldest = *std::min_element(origin.assemblies.begin(), origin.assemblies.end(),
                                         [](const Assembly &a, const Assembly &b) { return a.last_use < b.last_use; });
    if (oldest.state.count != 0) {
        tally_.add(Cause::message_abandoned);
    }
    oldest.message.assign(len, 0);
    oldest.last_use = clock_;
    tsr_reassembly_init(&oldest.state, oldest.message.data(), oldest.message.size());
    tsr_reassembly_begin(&oldest.state, &fragment);
    return &oldest;
}

Receiver::Verdict Receiver::finish(Origin &origin, Assembly &assembly, const tsr_fragment &fragment)
{
    Verdict verdict;
    verdict.node = fragment.origin;
    tsr_message_header header{};
    std::span<const std::uint8_t> body;
    if (const auto cause = open_message(origin, assembly, header, body)) {
        tally_.add(*cause);
        tsr_reassembly_begin(&assembly.state, &fragment);
        verdict.status = tsr_body_status_of(&assembly.state, TSR_DELIVERY_COMMITTED);
        return verdict;
    }
    tsr_delivery state = TSR_DELIVERY_COMMITTED;
    try {
        if (const auto cause = store_message(origin, header, body, verdict)) {
            tally_.add(*cause);
            state = TSR_DELIVERY_REFUSED;
        }
    } catch (const StoreError &) {
        /* Nothing is promised; the node asks again and sends again. */
        tally_.add(Cause::store_failed);
        selector_.reload();
        assembly.state.count = 0;
        return {};
    }
    assembly.state.count = 0;
    assembly.last_use = 0;
    origin.finished.push_front({fragment.message_id, state});
    if (origin.finished.size() > kFinishedMax) {
        origin.finished.pop_back();
    }
    verdict.status = whole_status(fragment.message_id, state);
    return verdict;
}

/* Authentic: header and body are filled. Otherwise the cause, and the message is no use. */
std::optional<Cause> Receiver::open_message(Origin &origin, Assembly &assembly, tsr_message_header &header,
                                            std::span<const std::uint8_t> &body)
{
    const tsr_reassembly &whole = assembly.state;
    if (tsr_message_parse(whole.message, whole.message_len, whole.origin, whole.destination, &header) != TSR_OK ||
        (header.kind != TSR_MESSAGE_MAP && header.kind != TSR_MESSAGE_EVENT) || header.key_use != TSR_KEY_NODE ||
        static_cast<std::uint16_t>(header.counter) != whole.message_id) {
        return Cause::message_format;
    }
    std::size_t body_len = 0;
    if (tsr_message_open(&header, &origin.cipher, whole.message, whole.message_len, &body_len) != TSR_OK) {
        return Cause::not_authentic;
    }
    body = {whole.message + TSR_MESSAGE_HEADER_LEN, body_len};
    return std::nullopt;
}

std::optional<Cause> Receiver::store_message(const Origin &origin, const tsr_message_header &header,
                                             std::span<const std::uint8_t> body, Verdict &verdict)
{
    if (origin.pair == nullptr) {
        return Cause::no_pair;
    }
    return header.kind == TSR_MESSAGE_EVENT ? store_events(origin, header, body, verdict)
                                            : store_map(origin, header, body, verdict);
}

void Receiver::begin_storing(Verdict &verdict)
{
    if (!in_transaction_) {
        store_.begin();
        in_transaction_ = true;
    }
    verdict.stored = true;
}

std::optional<Cause> Receiver::store_events(const Origin &origin, const tsr_message_header &header,
                                            std::span<const std::uint8_t> body, Verdict &verdict)
{
    auto message = read_event_message(body, *origin.pair);
    if (const Cause *cause = std::get_if<Cause>(&message)) {
        return *cause;
    }
    auto &stored = std::get<StoredEvents>(message);
    stored.node = header.origin;
    stored.counter = header.counter;
    begin_storing(verdict);
    switch (store_.insert(stored)) {
    case Insertion::counter_reused: return Cause::counter_reused;
    case Insertion::already_stored: repeated_++; return std::nullopt;
    case Insertion::stored: break;
    }
    verdict.events = EventReport{origin.pair, std::move(stored)};
    return std::nullopt;
}

std::optional<Cause> Receiver::store_map(const Origin &origin, const tsr_message_header &header,
                                         std::span<const std::uint8_t> body, Verdict &verdict)
{
    auto message = read_map_message(body, *origin.pair);
    if (const Cause *cause = std::get_if<Cause>(&message)) {
        return *cause;
    }
    auto &[map, stored] = std::get<MapMessage>(message);
    stored.node = header.origin;
    stored.counter = header.counter;
    begin_storing(verdict);
    if (store_.find(stored.node, stored.counter)) {
        repeated_++;
    } else {
        const std::optional<MapComparison> comparison = selector_.judge(stored.node, map);
        stored.kept = !comparison || !comparison->similar;
        if (comparison) {
            stored.mse_px2 = comparison->mse_px2;
        }
    }
    switch (store_.insert(stored)) {
    case Insertion::counter_reused: return Cause::counter_reused;
    case Insertion::already_stored: return std::nullopt;
    case Insertion::stored: break;
    }
    verdict.report = MapReport{stored.node,
                               origin.pair->name,
                               stored.counter,
                               stored.capture_time_us,
                               stored.coded_map.size(),
                               stored.coded_reference.size(),
                               stored.kept,
                               stored.mse_px2};
    return std::nullopt;
}

} // namespace tsr

/*
 * Counters of everything the sink refuses, one per cause, so that nothing is
 * dropped without a trace.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SINK_TALLY_H
#define TSR_SINK_TALLY_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tsr
{

enum class Cause {
    link_damaged,         /* gateway link: wrong FCS, length or type */
    link_unexpected,      /* a frame that only the sink sends */
    hello_refused,        /* another link version or PAN; also what follows it */
    fragment_format,      /* bytes that are no fragment */
    other_destination,    /* a fragment that is not for the sink */
    unknown_node,         /* origin not in site.toml */
    no_key,               /* origin without a key */
    message_too_long,     /* more fragments than a message can have */
    fragment_contradicts, /* does not fit the fragments before it */
    message_abandoned,    /* its place was needed before it was complete */
    message_format,       /* header of the message, or its kind */
    not_authentic,        /* wrong key or changed bytes */
    body_format,          /* authentic, but neither a map nor events */
    map_format,           /* the coded map does not decode */
    reference_format,     /* the coded reference image does not decode, or has another size */
    no_pair,              /* origin matches no pair of site.toml */
    other_settings, /* size, disparities or d0 differ from site.toml, or an event is of a zone that it does not have */
    counter_reused, /* a second, different message under one counter */
    store_failed,   /* the database did not commit */
    cause_count
};

/* The enumerator's name; the string is static. */
std::string_view cause_name(Cause cause);

class Tally
{
  public:
    void add(Cause cause, std::uint64_t times = 1) { counts_[static_cast<std::size_t>(cause)] += times; }
    std::uint64_t count(Cause cause) const { return counts_[static_cast<std::size_t>(cause)]; }

  private:
    std::array<std::uint64_t, static_cast<std::size_t>(Cause::cause_count)> counts_{};
};

} // namespace tsr

#endif

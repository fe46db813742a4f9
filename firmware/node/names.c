/*
 * Names of roles, phases and kinds of work, for traces and reports.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/node/node.h"

const char *tsr_role_name(enum tsr_role role)
{
    static const char *const names[] = {"none", "gateway", "relay", "lead", "wing", "binocular"};
    return (unsigned)role < sizeof names / sizeof names[0] ? names[role] : "unknown";
}

const char *tsr_phase_name(enum tsr_node_phase phase)
{
    static const char *const names[TSR_PHASE_COUNT] = {"idle",      "watching",  "waking",   "capturing", "receiving",
                                                       "unpacking", "reference", "matching", "median",    "measuring",
                                                       "comparing", "filtering", "encoding", "sealing",   "sending"};
    return (unsigned)phase < TSR_PHASE_COUNT ? names[phase] : "unknown";
}

const char *tsr_work_name(enum tsr_work_kind kind)
{
    static const char *const names[TSR_WORK_COUNT] = {
        "none",        "change",           "match",       "median", "measure", "compare", "map_encode", "view_filter",
        "view_encode", "reference_encode", "view_decode", "seal",   "copy"};
    return (unsigned)kind < TSR_WORK_COUNT ? names[kind] : "unknown";
}

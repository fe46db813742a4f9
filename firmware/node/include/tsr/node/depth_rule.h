/*
 * Depth rules: what in a watched zone of the map is worth an EVENT message.
 *
 *   nearer   share of pixels with Z <= limit     begins at begin_px, ends below end_px
 *   farther  share of pixels with Z > limit      likewise
 *   surface  Z of the surface in the zone        whenever |Z - Z reported| >= change_mm
 *
 *   Z = scale / (d + d0)                         docs/math.md, eqs. (4), (97)
 *
 * Rules look at each map after the median, before it is quantised, so at 1/16
 * px. What the sink has not committed counts as not reported: the next map is
 * made without waiting for a change, and judged against the old report. A
 * surface's first depth is an event, too.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_NODE_DEPTH_RULE_H
#define TSR_NODE_DEPTH_RULE_H

#include "tsr/vision/zone.h"
#include "tsr/wire/body.h"

#define TSR_DEPTH_RULES_MAX TSR_BODY_EVENTS_MAX /* of a node: what one EVENT can tell of */

struct tsr_depth_rule {
    struct tsr_zone_config zone; /* limit_q4: of d, at the limit's depth */
    uint32_t begin_px;           /* pixels that count, 1 .. those of the zone; a surface: fewer have no depth */
    uint32_t end_px;             /* 1 .. begin_px; a surface has none */
    uint32_t scale_q8;           /* surface: f B, px mm, UQ24.8, >= 1 */
    uint16_t change_mm;          /* surface: >= 1 */
};

#endif

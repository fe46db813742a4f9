/*
 * Configuration check and memory plan.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "internal.h"
#include "tsr/base/disparity.h"

#define STEP_LOG2_MAX 4u

bool tsr_node_is_camera(enum tsr_role role)
{
    return role == TSR_ROLE_LEAD || role == TSR_ROLE_WING || role == TSR_ROLE_BINOCULAR;
}

bool tsr_node_watches(enum tsr_role role)
{
    return role == TSR_ROLE_LEAD || role == TSR_ROLE_BINOCULAR;
}

/* The MAC keeps the frame counter of so many neighbours, and hears no more. */
static bool too_many_neighbours(const struct tsr_routes *routes)
{
    unsigned neighbours = routes->parent == TSR_ADDRESS_NONE ? 0 : 1;
    for (unsigned i = 0; i < routes->descendant_count; i++) {
        bool first = routes->descendants[i].next_hop != routes->parent;
        for (unsigned j = 0; j < i && first; j++) {
            first = routes->descendants[j].next_hop != routes->descendants[i].next_hop;
        }
        neighbours += first ? 1 : 0;
    }
    return neighbours > TSR_MAC_NEIGHBOURS_MAX;
}

/* Lead and wing hear each other directly: one frame's end is their clock. */
static bool bad_partner(const struct tsr_node_config *config)
{
    if (config->role != TSR_ROLE_LEAD && config->role != TSR_ROLE_WING) {
        return config->partner != TSR_ADDRESS_NONE;
    }
    return config->partner < TSR_ADDRESS_NODE_MIN || config->partner > TSR_ADDRESS_NODE_MAX ||
           config->partner == config->address || tsr_route_next(&config->routes, config->partner) != config->partner;
}

static const char *bad_network_field(const struct tsr_node_config *config)
{
    if (config->role < TSR_ROLE_GATEWAY || config->role > TSR_ROLE_BINOCULAR) {
        return "role";
    }
    if (config->address < TSR_ADDRESS_NODE_MIN || config->address > TSR_ADDRESS_NODE_MAX) {
        return "address";
    }
    if (config->channel < 11 || config->channel > 26) {
        return "channel";
    }
    if ((config->role == TSR_ROLE_GATEWAY) != (config->routes.parent == TSR_ADDRESS_NONE)) {
        return "routes.parent";
    }
    if (config->routes.descendant_count > 0 &&
        (config->routes.descendants == NULL || too_many_neighbours(&config->routes))) {
        return "routes.descendants";
    }
    return bad_partner(config) ? "partner" : NULL;
}

static const char *bad_camera_field(const struct tsr_node_config *config)
{
    const char *field = NULL;
    if (config->watch_period_us == 0 && tsr_node_watches(config->role)) {
        return "watch_period_us";
    }
    if (tsr_change_check(&config->change, &field) != TSR_OK || tsr_match_check(&config->match, &field) != TSR_OK ||
        tsr_similarity_check(&config->similarity, &field) != TSR_OK) {
        return field;
    }
    if (config->match.mode > TSR_MATCH_SAD8) { /* what tsr_match_start_sad() takes */
        return "mode";
    }
    if (config->match.right_is_prefiltered) { /* the role says it */
        return "right_is_prefiltered";
    }
    if (config->change.width != config->match.width || config->similarity.width != config->match.width) {
        return "width";
    }
    if (config->change.height != config->match.height || config->similarity.height != config->match.height) {
        return "height";
    }
    if (config->step_log2 > STEP_LOG2_MAX) {
        return "step_log2";
    }
    const char *bad_rule = tsr_node_check_rules(config);
    if (bad_rule != NULL) {
        return bad_rule;
    }
    if (config->reference_step > TSR_PICTURE_STEP_MAX && config->reference_step != TSR_REFERENCE_NONE) {
        return "reference_step";
    }
    return NULL;
}

enum tsr_status tsr_node_check(const struct tsr_node_config *config, const char **field)
{
    const char *bad = config == NULL ? "config" : bad_network_field(config);
    if (bad == NULL && tsr_node_is_camera(config->role)) {
        bad = bad_camera_field(config);
    }
    if (bad != NULL && field != NULL) {
        *field = bad;
    }
    return bad == NULL ? TSR_OK : TSR_ERR_ARG;
}

static size_t larger(size_t a, size_t b)
{
    return a > b ? a : b;
}

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

static struct tsr_map_info map_info_of(const struct tsr_node_config *config)
{
    struct tsr_map_info info = {0};
    info.width = config->match.width;
    info.height = config->match.height;
    info.disparities = config->match.disparities;
    info.step_log2 = config->step_log2;
    return info;
}

/* A map of any content has room. So has a usual map with its reference image,
 * which take a part of that; what exceeds it goes without the reference image. */
static size_t message_region_len(const struct tsr_node_config *config)
{
    struct tsr_map_info info = map_info_of(config);
    size_t view_len = TSR_BODY_VIEW_HEADER_LEN + TSR_VIEW_ENCODED_LEN_MAX(config->match.width, config->match.height);
    size_t map_len = TSR_BODY_MAP_HEADER_LEN + tsr_map_encoded_len_max(&info);
    size_t body_len = config->role == TSR_ROLE_WING   ? view_len
                      : config->role == TSR_ROLE_LEAD ? larger(view_len, map_len)
                                                      : map_len;
    return smaller(body_len, TSR_CCM_TEXT_MAX) + TSR_MESSAGE_OVERHEAD_LEN;
}

static size_t scratch_region_len(const struct tsr_node_config *config)
{
    size_t width = config->match.width;
    if (config->role == TSR_ROLE_WING) {
        return larger(sizeof(struct tsr_view_encoder) + TSR_VIEW_TILE_COUNT(width, config->match.height) +
                          TSR_VIEW_SCRATCH_LEN(width),
                      TSR_PREFILTER_SCRATCH_LEN(width));
    }
    size_t picture_encode = sizeof(struct tsr_picture_encoder) + TSR_PICTURE_SCRATCH_LEN(width);
    size_t view_decode = sizeof(struct tsr_view_decoder) + TSR_VIEW_SCRATCH_LEN(width);
    size_t map_encode = sizeof(struct tsr_map_encoder) + sizeof(uint16_t) * TSR_MAP_SCRATCH_COUNT(width);
    size_t match = tsr_match_scratch_len(&config->match);
    size_t filter = larger(TSR_MEDIAN_SCRATCH_LEN(width), sizeof(struct tsr_zone));
    return larger(larger(picture_encode, view_decode), larger(larger(map_encode, match), filter));
}

enum tsr_status tsr_node_plan_memory(const struct tsr_node_config *config, struct tsr_memory_plan *plan)
{
    if (tsr_node_check(config, NULL) != TSR_OK) {
        return TSR_ERR_ARG;
    }
    memset(plan, 0, sizeof *plan);
    if (!tsr_node_is_camera(config->role)) {
        return TSR_OK;
    }
    size_t pixels = (size_t)config->match.width * config->match.height;
    plan->len[TSR_REGION_PAIR] = pixels;
    plan->len[TSR_REGION_MESSAGE] = message_region_len(config);
    plan->len[TSR_REGION_SCRATCH] = scratch_region_len(config);
    if (tsr_node_watches(config->role)) {
        plan->len[TSR_REGION_PAIR] = tsr_match_pair_len(&config->match);
        plan->len[TSR_REGION_LAST_MAP] = pixels * sizeof(uint16_t);
        plan->len[TSR_REGION_CHANGE] = tsr_change_state_len(&config->change);
    }
    if (config->role == TSR_ROLE_LEAD || config->role == TSR_ROLE_WING) {
        plan->len[TSR_REGION_HELD_VIEW] = TSR_VIEW_HELD_LEN(config->match.width, config->match.height);
    }
    for (unsigned region = 0; region < TSR_REGION_COUNT; region++) {
        size_t aligned = (plan->len[region] + TSR_NODE_MEMORY_ALIGN - 1) & ~(size_t)(TSR_NODE_MEMORY_ALIGN - 1);
        plan->offset[region] = plan->total;
        plan->total += aligned;
    }
    return TSR_OK;
}

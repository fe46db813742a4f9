/*
 * What tsr_node_plan_memory gives on this machine, for docs/memory.md: a line
 *
 *   ROLE WIDTH HEIGHT DISPARITIES TOTAL OFFSET LEN OFFSET LEN ...
 *
 * per role and size, regions in the order of enum tsr_region, and a line
 * "sizeof NAME BYTES" for what else a node needs.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/hal/mps2_semihosting.h"
#include "tsr/node/node_state.h"

struct size {
    uint16_t width;
    uint16_t height;
    uint16_t disparities;
};

static void print_number(size_t number)
{
    tsr_mps2_print_number((uint32_t)number);
    tsr_mps2_print(" ");
}

static int print_plan(enum tsr_role role, const struct size *size)
{
    static const struct tsr_route kToWing = {2, 2};
    struct tsr_node_config config = {0};
    config.role = role;
    config.address = 1;
    config.partner = role == TSR_ROLE_LEAD || role == TSR_ROLE_WING ? 2 : TSR_ADDRESS_NONE;
    config.channel = 15;
    config.routes.parent = role == TSR_ROLE_GATEWAY ? TSR_ADDRESS_NONE : role == TSR_ROLE_WING ? 2 : 3;
    if (role == TSR_ROLE_LEAD) {
        config.routes.descendants = &kToWing;
        config.routes.descendant_count = 1;
    }
    config.watch_period_us = 1;
    config.change.width = config.match.width = config.similarity.width = size->width;
    config.change.height = config.match.height = config.similarity.height = size->height;
    config.match.disparities = size->disparities;
    config.step_log2 = 3;
    struct tsr_memory_plan plan;
    const char *field = NULL;
    if (tsr_node_check(&config, &field) != TSR_OK || tsr_node_plan_memory(&config, &plan) != TSR_OK) {
        tsr_mps2_print(tsr_role_name(role));
        tsr_mps2_print(": refused field: ");
        tsr_mps2_print(field != NULL ? field : "none");
        tsr_mps2_print("\n");
        return 1;
    }
    tsr_mps2_print(tsr_role_name(role));
    tsr_mps2_print(" ");
    print_number(size->width);
    print_number(size->height);
    print_number(size->disparities);
    print_number(plan.total);
    for (unsigned region = 0; region < TSR_REGION_COUNT; region++) {
        print_number(plan.offset[region]);
        print_number(plan.len[region]);
    }
    tsr_mps2_print("\n");
    return 0;
}

static void print_sizeof(const char *name, size_t len)
{
    tsr_mps2_print("sizeof ");
    tsr_mps2_print(name);
    tsr_mps2_print(" ");
    print_number(len);
    tsr_mps2_print("\n");
}

int main(void)
{
    static const struct size kSizes[] = {{160, 120, 32}, {320, 240, 64}};
    static const enum tsr_role kRoles[] = {TSR_ROLE_WING, TSR_ROLE_LEAD, TSR_ROLE_BINOCULAR, TSR_ROLE_RELAY,
                                           TSR_ROLE_GATEWAY};
    int failed = 0;
    for (unsigned i = 0; i < sizeof kSizes / sizeof kSizes[0]; i++) {
        for (unsigned j = 0; j < sizeof kRoles / sizeof kRoles[0]; j++) {
            failed |= print_plan(kRoles[j], &kSizes[i]);
        }
    }
    print_sizeof("tsr_node", sizeof(struct tsr_node));
    print_sizeof("tsr_mac", sizeof(struct tsr_mac));
    print_sizeof("tsr_cipher", sizeof(struct tsr_cipher));
    print_sizeof("tsr_sender", sizeof(struct tsr_sender));
    print_sizeof("tsr_reassembly", sizeof(struct tsr_reassembly));
    print_sizeof("tsr_uplink", sizeof(struct tsr_uplink));
    print_sizeof("tsr_map_encoder", sizeof(struct tsr_map_encoder));
    print_sizeof("tsr_picture_encoder", sizeof(struct tsr_picture_encoder));
    print_sizeof("tsr_view_encoder", sizeof(struct tsr_view_encoder));
    return failed;
}

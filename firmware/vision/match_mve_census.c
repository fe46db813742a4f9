/*
 * Census sums of a row with MVE: the window slides over column sums that are
 * moved down already, and its sums are keys as match_mve_window.h says.
 *
 * Columns are up to 240, so that what enters less what leaves does not fit a
 * byte: both are widened first.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

#ifdef TSR_MATCH_HAS_MVE

#include <string.h>

#include "match_mve.h"
#include "match_mve_search.h"

#define CLAIM_SHIFT 3u

/* Keys += column - leave; the least key. */
static inline unsigned move_keys(const struct mve_window *window)
{
    const uint8_t *column = window->column;
    const uint8_t *leave = window->leave;
    uint16_t *even = window->even;
    uint16_t *odd = window->odd;
    unsigned least;
    __asm volatile("vmov.i8 q6, #0xff\n\t"
                   "dlstp.8 lr, %[lanes]\n"
                   "1:\n\t"
                   "vldrb.u8 q0, [%[column]], #16\n\t"
                   "vshllb.u8 q2, q0, %[shift]\n\t"
                   "vldrb.u8 q1, [%[leave]], #16\n\t"
                   "vshllt.u8 q0, q0, %[shift]\n\t"
                   "vldrh.u16 q4, [%[even]]\n\t"
                   "vshllb.u8 q3, q1, %[shift]\n\t"
                   "vadd.i16 q2, q2, q4\n\t"
                   "vldrh.u16 q5, [%[odd]]\n\t"
                   "vsub.i16 q2, q2, q3\n\t"
                   "vshllt.u8 q1, q1, %[shift]\n\t"
                   "vstrh.16 q2, [%[even]], #16\n\t"
                   "vadd.i16 q0, q0, q5\n\t"
                   "vmin.u16 q6, q6, q2\n\t"
                   "vsub.i16 q0, q0, q1\n\t"
                   "vstrh.16 q0, [%[odd]], #16\n\t"
                   "vmin.u16 q6, q6, q0\n\t"
                   "letp lr, 1b\n\t"
                   "mvn %[least], #0\n\t"
                   "vminv.u16 %[least], q6"
                   : [least] "=r"(least), [column] "+r"(column), [leave] "+r"(leave), [even] "+r"(even), [odd] "+r"(odd)
                   : [lanes] "r"(window->lanes), [shift] "i"(MVE_KEY_SHIFT)
                   : "q0", "q1", "q2", "q3", "q4", "q5", "q6", "lr", "memory");
    return least;
}

/* The keys of the first column that counts, as if it stood there `window` times; all are barred. */
static struct mve_window begin_keys(const struct tsr_match *match, unsigned first)
{
    unsigned disparities = match->config.disparities;
    uint8_t *column = tsr_match_share_scratch(match).columns + (size_t)first * disparities;
    uint16_t *even = (uint16_t *)(void *)match->scratch;
    uint16_t *odd = even + disparities / 2u + MVE_PAD;
    memset(even + disparities / 2u, 0xff, sizeof *even * MVE_PAD);
    memset(odd + disparities / 2u, 0xff, sizeof *odd * MVE_PAD);
    mve_fill_keys(even, odd, disparities, column, match->config.window);
    return (struct mve_window){.column = column, .leave = column, .even = even, .odd = odd, .lanes = disparities};
}

static void slide(const struct tsr_match *match)
{
    const struct tsr_match_config *config = &match->config;
    struct tsr_match_scratch scratch = tsr_match_share_scratch(match);
    unsigned start = (unsigned)config->search_start_px;
    unsigned radius = config->window / 2u;
    unsigned last = config->width - 1u;
    unsigned first = start > radius ? start - radius : 0u;
    struct mve_uniqueness uniqueness = mve_uniqueness_of(config);
    struct mve_window window = begin_keys(match, first);
    struct tsr_mve_found found[TSR_MVE_FOUND_COUNT];
    uint16_t *choices = scratch.choices + start;
    unsigned count = 0;
    for (unsigned enter = first + 1u; enter <= last + radius; enter++) {
        unsigned pixel = enter - radius - start; /* lane `pixel` is searched from this one on */
        window.column += enter <= last ? window.lanes : 0u;
        window.leave += enter > first + config->window ? window.lanes : 0u;
        if (pixel < window.lanes) {
            uint16_t *key = (pixel % 2u != 0 ? window.odd : (uint16_t *)window.even) + pixel / 2u;
            *key = (uint16_t)(*key ^ MVE_KEY_BARRED);
        }
        unsigned key = move_keys(&window);
        if (enter < start + radius) {
            continue;
        }
        found[count++] = mve_search_keys(&uniqueness, &window, scratch.claims + pixel, CLAIM_SHIFT, key);
        if (count == TSR_MVE_FOUND_COUNT) {
            tsr_mve_choose(found, count, MVE_KEY_SHIFT, 0, choices);
            choices += count;
            count = 0;
        }
    }
    tsr_mve_choose(found, count, MVE_KEY_SHIFT, 0, choices);
}

/* Adding modulo 256, so that taking away is adding 255 times. */
void tsr_mve_census_row(const struct tsr_match *match, unsigned y, unsigned y_new, unsigned y_old)
{
    struct tsr_match_scratch scratch = tsr_match_share_scratch(match);
    tsr_mve_add_census(match, y_old, UINT8_MAX);
    tsr_mve_add_census(match, y_new, 1u);
    memset(scratch.claims, 0xff, sizeof *scratch.claims * match->config.width);
    memset(scratch.choices, 0xff, sizeof *scratch.choices * (unsigned)match->config.search_start_px);
    slide(match);
    tsr_mve_write_row(match, y);
}
#endif

/*
 * The label model of the disparity-map codec, docs/codec.md, chapter 2: what
 * the directions share.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_MAP_MODEL_H
#define TSR_CODEC_MAP_MODEL_H

#include <stdbool.h>

#include "tsr/codec/map_trace.h"

/* Scratch holds three rows of labels, used in turn, with pads that stay "no match": outside the map there is none. */
#define TSR_MAP_PAD_LEFT 3u
#define TSR_MAP_PAD_RIGHT 2u
#define TSR_MAP_ROW_COUNT 3u
_Static_assert(TSR_MAP_SCRATCH_COUNT(0) == TSR_MAP_ROW_COUNT * (TSR_MAP_PAD_LEFT + TSR_MAP_PAD_RIGHT),
               "the public header sizes the rows");

/* A label is disparity >> step_log2, and this for TSR_DISPARITY_INVALID: at least 3,968 from every other label,
 * while those differ by less than 2,048. It is positive as an int16_t. */
#define TSR_MAP_LABEL(value, step_log2) ((uint16_t)((unsigned)(value) >> (step_log2)&0x7fffu))
#define TSR_MAP_DIFFERENCE_INVALID 2048u

/* How fast contexts learn, tsr_fixed_learn(): whole maps, and packets, which are over before long. */
#define TSR_MAP_SHIFT 6u
#define TSR_MAP_PACKET_SHIFT 5u

/* Calls that few pixels make, kept out of the code that most run through. */
#define TSR_OUT_OF_LINE __attribute__((noinline))

/* Pixels that are coded alike, as labels or literally. */
#define TSR_MAP_LITERAL_PIXELS 16u
/* A map that has cost this much more than its literal size is stored literally until it is cheap again. */
#define TSR_MAP_SLACK_LEN 256u

/* Where each question's contexts begin among the cells. */
enum {
    TSR_MAP_FLAT_AT = 0,                            /* 48: is a flat neighbourhood continued? */
    TSR_MAP_INVALID_AT = TSR_MAP_FLAT_AT + 48,      /* 16 x 6: no match? */
    TSR_MAP_PREDICTED_AT = TSR_MAP_INVALID_AT + 96, /* 6 x 6: the prediction? */
    TSR_MAP_SIGN_AT = TSR_MAP_PREDICTED_AT + 36,    /* 27: below it? */
    TSR_MAP_NEARER_AT = TSR_MAP_SIGN_AT + 27,       /* 4 x 12: farther than 0, 1, 2, 3? */
    TSR_MAP_FARTHER_AT = TSR_MAP_NEARER_AT + 48,    /* 9: beyond bucket 4, 5 ...? */
    TSR_MAP_HALF_AT = TSR_MAP_FARTHER_AT + 9,       /* 10: in the upper half of its bucket? */
    TSR_MAP_TRAINED_END = TSR_MAP_HALF_AT + 10,
    /* TSR_MAP_CANDIDATE_AT, by kind and level: is it this label? */
    TSR_MAP_CELLS_END = TSR_MAP_CANDIDATE_AT + TSR_MAP_KIND_COUNT * TSR_MAP_LEVEL_COUNT
};
_Static_assert(TSR_MAP_TRAINED_END == TSR_MAP_TRAINED_CELL_COUNT && TSR_MAP_CELLS_END == TSR_MAP_CELL_COUNT,
               "the public headers size the model");

/* What was learned from maps; log-odds in eighths, and P(1) in UQ0.16. A reference has tables and contexts of its own,
 * so that what codes maps alone need not hold them. */
struct tsr_map_prior {
    uint8_t id;           /* in the header, 1 .. 15 */
    uint16_t matcher_crc; /* of the maps of the matcher it was trained for */
    int8_t weights[TSR_MAP_KIND_COUNT][TSR_MAP_TABLE_COUNT_ALONE][TSR_MAP_TABLE_LEN];
    uint16_t cells[TSR_MAP_CODING_REFERENCE][TSR_MAP_TRAINED_CELL_COUNT]; /* alone, near, in packets */
};
struct tsr_map_reference_prior {
    int8_t weights[TSR_MAP_KIND_COUNT][TSR_MAP_TABLE_COUNT - TSR_MAP_TABLE_COUNT_ALONE][TSR_MAP_TABLE_LEN];
    uint16_t cells[TSR_MAP_TRAINED_CELL_COUNT];
};
extern const struct tsr_map_prior tsr_map_prior; /* map_prior.c, made by tarsier train-prior */
extern const struct tsr_map_reference_prior tsr_map_reference_prior;

static inline uint16_t *tsr_map_row_labels(const struct tsr_map_model *model, unsigned rows_up)
{
    const size_t at = (model->row + TSR_MAP_ROW_COUNT - rows_up) % TSR_MAP_ROW_COUNT;
    return model->scratch + at * (model->info.width + TSR_MAP_PAD_LEFT + TSR_MAP_PAD_RIGHT) + TSR_MAP_PAD_LEFT;
}

/* The level of a sum of weights: rounded to quarters. The bias keeps it positive: eight weights of -128 .. 127. */
static inline unsigned tsr_map_level(int sum)
{
    const unsigned quarters = (unsigned)(sum + 1024 + 1) / 2u;
    return quarters < 480u ? 0 : quarters > 543u ? 63u : quarters - 480u;
}

/* Check and begin, the trained contexts as cells[TSR_MAP_TRAINED_CELL_COUNT] say: TSR_ERR_ARG, TSR_ERR_SIZE or
 * TSR_ERR_NOBUF as tsr_map_encode_start. */
enum tsr_status tsr_map_model_start(struct tsr_map_model *model, const struct tsr_map_info *info,
                                    const struct tsr_map_reference *reference, const uint16_t *cells, uint16_t *scratch,
                                    size_t scratch_cap);

bool tsr_map_is_valid_info(const struct tsr_map_info *info);

/* Is it invalid, or a multiple of the step below 16 * disparities? */
bool tsr_map_is_valid_value(const struct tsr_map_info *info, unsigned value);

/* Put a row of disparities, as labels, into row model->row of the scratch; false if one is neither invalid nor a
 * multiple of the step below 16 * disparities. */
bool tsr_map_take_row(struct tsr_map_model *model, const uint16_t *row);

/* Code row model->row, whose labels stand in the scratch, and step to the next. With near > 0 the labels become those
 * that a decoder will find. */
void tsr_map_encode_row(struct tsr_map_model *model, struct tsr_range_encoder *range);
void tsr_map_encode_reference_row(struct tsr_map_model *model, struct tsr_range_encoder *range);

/* Decode row model->row into the scratch and step to the next; false if it meets a label that does not exist. */
bool tsr_map_decode_row(struct tsr_map_model *model, struct tsr_range_decoder *range);
bool tsr_map_decode_reference_row(struct tsr_map_model *model, struct tsr_range_decoder *range);

/* Columns first .. end - 1 of row model->row of a packet, from the left; the caller steps. */
void tsr_map_encode_span(struct tsr_map_model *model, struct tsr_range_encoder *range, unsigned first, unsigned end);
bool tsr_map_decode_span(struct tsr_map_model *model, struct tsr_range_decoder *range, unsigned first, unsigned end);

#endif

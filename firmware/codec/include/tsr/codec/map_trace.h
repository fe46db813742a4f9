/*
 * The questions that the map codec would ask about a map, one by one, for
 * whoever trains the tables that choose their contexts (docs/codec.md, 2.8).
 * No node uses this, so none links it.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_MAP_TRACE_H
#define TSR_CODEC_MAP_TRACE_H

#include "tsr/codec/map.h"

/* Shape of the tables: a candidate's context is the rounded sum of one weight from each table of its kind; those
 * beyond TSR_MAP_TABLE_COUNT_ALONE count only against a reference. */
#define TSR_MAP_KIND_COUNT 6
#define TSR_MAP_TABLE_COUNT_ALONE 5
#define TSR_MAP_TABLE_COUNT 8
#define TSR_MAP_TABLE_LEN 64
#define TSR_MAP_LEVEL_COUNT 64
#define TSR_MAP_WEIGHT_SCALE 8 /* weights are log-odds times this; a level is a quarter of log-odds */
/* Contexts that start as trained; after them kind k of a candidate has cells TSR_MAP_CANDIDATE_AT + k *
 * TSR_MAP_LEVEL_COUNT + level, which start as their level says. */
#define TSR_MAP_TRAINED_CELL_COUNT 274
#define TSR_MAP_CANDIDATE_AT TSR_MAP_TRAINED_CELL_COUNT

/* What a map was coded as decides where its contexts start. */
enum tsr_map_coding {
    TSR_MAP_CODING_ALONE,
    TSR_MAP_CODING_NEAR, /* in packets or not */
    TSR_MAP_CODING_PACKET,
    TSR_MAP_CODING_REFERENCE, /* near or not */
    TSR_MAP_CODING_COUNT
};

struct tsr_map_question {
    bool bit;                           /* the answer */
    bool is_candidate;                  /* kind and index count, else cell */
    uint8_t coding;                     /* of the map, enum tsr_map_coding */
    uint8_t kind;                       /* 0 .. TSR_MAP_KIND_COUNT - 1 */
    uint8_t table_count;                /* TSR_MAP_TABLE_COUNT or TSR_MAP_TABLE_COUNT_ALONE */
    uint8_t index[TSR_MAP_TABLE_COUNT]; /* 0 .. TSR_MAP_TABLE_LEN - 1, table_count of them */
    uint16_t cell;                      /* 0 .. TSR_MAP_CELL_COUNT - 1 */
};

typedef void (*tsr_map_question_fn)(void *user, const struct tsr_map_question *question);

/* The fingerprint of the matcher whose maps this build's prior was made from (tools/tarsier, matcher_fingerprint()). */
uint16_t tsr_map_prior_matcher_crc(void);

/*
 * Tell every question of a map, borrowed, width elements a row; info and reference as for tsr_map_encode_start, model
 * and scratch used meanwhile. Returns TSR_OK, or what tsr_map_encode_start or tsr_map_encode_rows would refuse.
 */
enum tsr_status tsr_map_trace(struct tsr_map_model *model, const struct tsr_map_info *info,
                              const struct tsr_map_reference *reference, const uint16_t *map, uint16_t *scratch,
                              size_t scratch_cap, tsr_map_question_fn tell, void *user);

/*
 * The same for the pixels first .. first + count - 1 of a map, as a packet that holds them is coded
 * (tsr/codec/map_packet.h); scratch_cap >= TSR_MAP_PACKET_SCRATCH_COUNT. Returns what tsr_map_packets_start or
 * tsr_map_packets_next would, TSR_ERR_SIZE for pixels beyond the map.
 */
enum tsr_status tsr_map_trace_packet(struct tsr_map_model *model, const struct tsr_map_info *info, const uint16_t *map,
                                     uint32_t first, uint32_t count, uint16_t *scratch, size_t scratch_cap,
                                     tsr_map_question_fn tell, void *user);

#endif

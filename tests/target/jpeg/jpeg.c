/*
 * The workbench of a baseline node: both views as JPEG files by libjpeg-turbo, gray, quality 50, the slow integer
 * transform, the standard's Huffman tables.
 *
 * It takes the place of workbench.c: the same machines, markers and files in,
 * left.jpg and right.jpg out. Counted is all that a view takes, from an
 * encoder that does not exist yet to one that does not exist any more.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdio.h>

#include <jpeglib.h>

#include "workbench.h"

#define QUALITY 50
#define ROWS_PER_STEP 8u /* a row of blocks */
#define FILE_CAP (2u * WORKBENCH_PIXELS_MAX)

static uint8_t view[WORKBENCH_PIXELS_MAX];
static uint8_t file[FILE_CAP];

static void fail(j_common_ptr jpeg)
{
    (void)jpeg;
    workbench_fail("libjpeg-turbo: an error");
}

static void say_nothing(j_common_ptr jpeg, int level)
{
    (void)jpeg;
    (void)level;
}

static void reset(j_common_ptr jpeg)
{
    (void)jpeg;
}

static void start_file(j_compress_ptr jpeg)
{
    jpeg->dest->next_output_byte = file;
    jpeg->dest->free_in_buffer = sizeof file;
}

static boolean fail_full(j_compress_ptr jpeg)
{
    (void)jpeg;
    workbench_fail("JPEG: longer than its buffer");
}

static void end_file(j_compress_ptr jpeg)
{
    (void)jpeg;
}

static void write_rows(j_compress_ptr jpeg)
{
    JSAMPROW rows[ROWS_PER_STEP];
    while (jpeg->next_scanline < jpeg->image_height) {
        JDIMENSION count = jpeg->image_height - jpeg->next_scanline;
        count = count < ROWS_PER_STEP ? count : ROWS_PER_STEP;
        for (JDIMENSION i = 0; i < count; i++) {
            rows[i] = view + (size_t)(jpeg->next_scanline + i) * jpeg->image_width;
        }
        jpeg_write_scanlines(jpeg, rows, count);
    }
}

/* The view's file; gives its length. */
static size_t encode_view(const struct workbench_case *bench)
{
    struct jpeg_error_mgr errors = {.error_exit = fail, .emit_message = say_nothing, .reset_error_mgr = reset};
    struct jpeg_destination_mgr destination = {
        .init_destination = start_file, .empty_output_buffer = fail_full, .term_destination = end_file};
    struct jpeg_compress_struct jpeg;
    jpeg.err = &errors;
    jpeg_create_compress(&jpeg);
    jpeg.dest = &destination;
    jpeg.image_width = bench->width;
    jpeg.image_height = bench->height;
    jpeg.input_components = 1;
    jpeg.in_color_space = JCS_GRAYSCALE;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, QUALITY, TRUE);
    jpeg.dct_method = JDCT_ISLOW;
    jpeg_start_compress(&jpeg, TRUE);
    write_rows(&jpeg);
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    return sizeof file - destination.free_in_buffer;
}

static void run_view(const struct workbench_case *bench, const char *from, const char *to, const char *work)
{
    size_t pixels = (size_t)bench->width * bench->height;
    workbench_load(from, view, pixels);
    workbench_begin();
    size_t len = encode_view(bench);
    workbench_end(work, pixels);
    workbench_store(to, file, len);
}

void workbench_run(const struct workbench_case *bench)
{
    workbench_expect(bench->width <= WORKBENCH_WIDTH_MAX && bench->height <= WORKBENCH_HEIGHT_MAX, "width or height");
    run_view(bench, "left.gray", "left.jpg", "jpeg_left");
    run_view(bench, "right.gray", "right.jpg", "jpeg_right");
    workbench_store_work();
}

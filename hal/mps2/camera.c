/*
 * Camera from a PGM file, or a test pattern.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/hal/mps2_camera.h"

#include <stddef.h>
#include <string.h>

#include "tsr/hal/mps2_semihosting.h"

#define HEADER_CAP 24
#define PLANES 3u
#define DISPARITY_MIN 4u
#define DISPARITY_STEP 5u  /* from plane to plane */
#define DISPARITY_SLOPE 6u /* across a plane's height */

/* "P5\nWIDTH HEIGHT\n255\n", as the project's own writer and most others have it. */
static size_t write_pgm_header(struct tsr_gray image, char header[HEADER_CAP])
{
    const uint16_t numbers[3] = {image.width, image.height, 255};
    static const char kAfter[3] = {' ', '\n', '\n'};
    size_t len = 3;
    memcpy(header, "P5\n", len);
    for (unsigned i = 0; i < 3; i++) {
        uint16_t divisor = 10000;
        while (divisor > numbers[i]) {
            divisor = (uint16_t)(divisor / 10u);
        }
        for (; divisor > 0; divisor = (uint16_t)(divisor / 10u)) {
            header[len++] = (char)('0' + numbers[i] / divisor % 10u);
        }
        header[len++] = kAfter[i];
    }
    return len;
}

static enum tsr_status read_picture(const char *file, struct tsr_gray image)
{
    char wanted[HEADER_CAP];
    uint8_t found[HEADER_CAP];
    size_t header_len = write_pgm_header(image, wanted);
    enum tsr_status status = tsr_mps2_read_file(file, 0, found, header_len);
    if (status == TSR_OK && memcmp(found, wanted, header_len) != 0) {
        status = TSR_ERR_SIZE;
    }
    for (uint16_t y = 0; y < image.height && status == TSR_OK; y++) {
        size_t offset = header_len + (size_t)y * image.width;
        status = tsr_mps2_read_file(file, offset, image.pixels + (size_t)y * image.stride, image.width);
    }
    return status;
}

/* Gray value of a dot; lowbias32 (C. Wellons, 2018) of its place. */
static uint8_t dot(uint32_t x, uint32_t y)
{
    uint32_t hash = y << 16 | x;
    hash = (hash ^ hash >> 16) * UINT32_C(0x7feb352d);
    hash = (hash ^ hash >> 15) * UINT32_C(0x846ca68b);
    return (uint8_t)((hash ^ hash >> 16) & 0xffu);
}

/* Surface point u of a row is seen at u by the left camera and at u - disparity by the right one. */
static void draw_pattern(struct tsr_gray image, bool right)
{
    for (uint32_t y = 0; y < image.height; y++) {
        uint32_t plane = y * PLANES / image.height;
        uint32_t disparity = DISPARITY_MIN + plane * DISPARITY_STEP + y * DISPARITY_SLOPE / image.height;
        for (uint32_t x = 0; x < image.width; x++) {
            image.pixels[y * image.stride + x] = dot(x + (right ? disparity : 0), y);
        }
    }
}

static enum tsr_status capture(void *self, struct tsr_gray image, uint64_t at_us)
{
    struct tsr_mps2_camera *camera = self;
    if (camera->busy) {
        return TSR_ERR_BUSY;
    }
    uint64_t now_us = camera->now_us();
    camera->busy = true;
    camera->image = image;
    camera->start_us = at_us > now_us ? at_us : now_us;
    return TSR_OK;
}

static const struct tsr_camera_ops kOps = {capture};

struct tsr_camera tsr_mps2_camera_init(struct tsr_mps2_camera *camera, const char *file, bool right,
                                       uint64_t (*now_us)(void), tsr_mps2_camera_handler handler, void *owner)
{
    memset(camera, 0, sizeof *camera);
    camera->now_us = now_us;
    camera->handler = handler;
    camera->owner = owner;
    camera->file = file;
    camera->right = right;
    struct tsr_camera view = {&kOps, camera};
    return view;
}

uint64_t tsr_mps2_camera_timer_us(const struct tsr_mps2_camera *camera)
{
    return camera->busy ? camera->start_us + TSR_MPS2_CAMERA_CAPTURE_US : UINT64_MAX;
}

void tsr_mps2_camera_poll(struct tsr_mps2_camera *camera)
{
    if (!camera->busy || camera->now_us() < tsr_mps2_camera_timer_us(camera)) {
        return;
    }
    enum tsr_status status = TSR_OK;
    if (camera->file != NULL) {
        status = read_picture(camera->file, camera->image);
    } else {
        draw_pattern(camera->image, camera->right);
    }
    camera->busy = false;
    camera->handler(camera->owner, status, camera->start_us);
}

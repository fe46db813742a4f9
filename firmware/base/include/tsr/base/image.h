/*
 * Views of 8-bit gray images: a pointer with its shape, never the owner.
 *
 * Pixel (x, y) is pixels[y * stride + x], x to the right, y down, 0 = black,
 * 255 = white (linearity is the camera's business). stride >= width, in pixels.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_BASE_IMAGE_H
#define TSR_BASE_IMAGE_H

#include <stdint.h>

/* Largest frame any module accepts; bounds every row buffer and counter. */
#define TSR_IMAGE_WIDTH_MAX 640
#define TSR_IMAGE_HEIGHT_MAX 480

struct tsr_gray {
    uint8_t *pixels;
    uint16_t width;
    uint16_t height;
    uint16_t stride;
};

struct tsr_gray_view {
    const uint8_t *pixels;
    uint16_t width;
    uint16_t height;
    uint16_t stride;
};

static inline struct tsr_gray_view tsr_gray_as_view(struct tsr_gray image)
{
    struct tsr_gray_view view = {image.pixels, image.width, image.height, image.stride};
    return view;
}

#endif

/*
 * Views of 8-bit gray images: a pointer with its shape, never the owner; and
 * parts of pictures.
 *
 * Pixel (x, y) is pixels[y * stride + x], x to the right, y down, 0 = black,
 * 255 = white (linearity is the camera's business). stride >= width, in pixels.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_BASE_IMAGE_H
#define TSR_BASE_IMAGE_H

#include <stdbool.h>
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

/* A part of a picture, px: columns x .. x + width - 1, rows y .. y + height - 1. */
struct tsr_rectangle {
    uint16_t x;
    uint16_t y;
    uint16_t width;
    uint16_t height;
};

/* Not empty, and inside a picture of this size. */
static inline bool tsr_rectangle_is_inside(const struct tsr_rectangle *part, uint16_t width, uint16_t height)
{
    return part->width > 0 && part->height > 0 && (uint32_t)part->x + part->width <= width &&
           (uint32_t)part->y + part->height <= height;
}

static inline struct tsr_gray_view tsr_gray_as_view(struct tsr_gray image)
{
    struct tsr_gray_view view = {image.pixels, image.width, image.height, image.stride};
    return view;
}

#endif

/*
 * Camera: one gray sensor that captures a frame at a given instant.
 *
 * capture() is answered by exactly one done event, which the owner of camera
 * and node connects; until then the image buffer is loaned to the camera. Rows
 * may be farther apart than the width (stride), so that the two views of a
 * pair can be captured interleaved, as the matcher wants them.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_CAMERA_H
#define TSR_HAL_CAMERA_H

#include <stdint.h>

#include "tsr/base/image.h"
#include "tsr/base/status.h"

struct tsr_camera_ops {
    /*
     * Begin exposure at at_us (in the past: at once) and fill image, whose width
     * and height choose the camera's mode.
     * TSR_ERR_BUSY while an earlier capture is unanswered; TSR_ERR_SIZE if the
     * camera has no mode of that size; TSR_ERR_IO.
     */
    enum tsr_status (*capture)(void *camera, struct tsr_gray image, uint64_t at_us);
};

struct tsr_camera {
    const struct tsr_camera_ops *ops;
    void *self;
};

#endif

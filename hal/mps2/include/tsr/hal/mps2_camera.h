/*
 * A camera in place of a sensor: the board has none.
 *
 *   from a file   a PGM picture (P5, 8 bit) of exactly the asked size, read by semihosting at every capture
 *   test pattern  the left or right view of three slanted planes covered with
 *                 random dots, disparities 4 .. 20 px; any size; every capture is the same
 *
 * A capture takes 30 ms, as exposure and readout of the emulator's cameras. The
 * owner calls tsr_mps2_camera_poll in place of a sensor's interrupt.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_MPS2_CAMERA_H
#define TSR_HAL_MPS2_CAMERA_H

#include <stdbool.h>

#include "tsr/hal/camera.h"

#define TSR_MPS2_CAMERA_CAPTURE_US 30000u

typedef void (*tsr_mps2_camera_handler)(void *owner, enum tsr_status status, uint64_t time_us);

/* Content belongs to the module. */
struct tsr_mps2_camera {
    uint64_t (*now_us)(void);
    tsr_mps2_camera_handler handler;
    void *owner;
    const char *file; /* NULL: test pattern */
    bool right;
    bool busy;
    struct tsr_gray image; /* of the capture under way */
    uint64_t start_us;
};

/* file: kept; NULL for the test pattern, whose view right chooses. owner is kept. */
struct tsr_camera tsr_mps2_camera_init(struct tsr_mps2_camera *camera, const char *file, bool right,
                                       uint64_t (*now_us)(void), tsr_mps2_camera_handler handler, void *owner);

/* Finish the capture under way if it has ended: TSR_ERR_IO if the file is not
 * there, TSR_ERR_SIZE if it is of another size or kind. */
void tsr_mps2_camera_poll(struct tsr_mps2_camera *camera);

/* When it ends; UINT64_MAX if none is under way. */
uint64_t tsr_mps2_camera_timer_us(const struct tsr_mps2_camera *camera);

#endif

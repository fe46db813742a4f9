/*
 * From a calibration to the rectified pair of views that a node computes.
 *
 * Where the calibration gives R and T alone, both cameras are turned by half of R
 * each and then together until the baseline is the x axis (J.-Y. Bouguet, *Camera
 * Calibration Toolbox for Matlab*; as cv::stereoRectify): docs/math.md, eq. (70).
 *
 * The camera's frame is the calibrated picture scaled to cover source, the
 * middle cut out. d0 becomes a multiple of 1/16 px, by moving the right view by
 * at most 1/32 px, so that what the site file says is what the table does.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_RECTIFICATION_H
#define TSR_HOST_RECTIFICATION_H

#include <optional>

#include "tsr/host/calibration.h"

namespace tsr
{

struct RectifyOptions {
    ImageSize output; /* of the rectified views; 0x0: the calibrated size */
    ImageSize source; /* of the camera's frames; 0x0: as output */
    /* 0: no pixel of a view is outside the frame, 1: no pixel of a frame is
     * lost, between: between. Default: the calibration's own views, or 0. */
    std::optional<double> zoom;
    /* Each view has its own middle column: more to see when cameras converge,
     * and d0 is not 0. Of views that are computed here only. */
    bool separate_centres = false;
};

struct Rectification {
    Camera left; /* giving frames of the source's size */
    Camera right;
    RectifiedViews views; /* in px of the output */
    ImageSize output;

    ImageSize source() const { return left.size; }
    double d0_px() const { return views.cx_right - views.cx_left; } /* eq. (3) with search start 0 */
    /* Where pixel (x, y) of a view is seen in its frame; docs/math.md, eq. (68). */
    Point2 source_position(bool right_view, Point2 pixel) const;
};

/* Throws InputError: epipole in or near the picture, cameras one above the other
 * or exchanged, views without a common part, sizes that the node cannot hold. */
Rectification rectify_calibration(const StereoCalibration &calibration, const RectifyOptions &options);

} // namespace tsr

#endif

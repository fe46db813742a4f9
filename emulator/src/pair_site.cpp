/*
 * A site from two folders of frames.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/emulator/pair_site.h"

#include <algorithm>
#include <cmath>

#include "tsr/host/input_error.h"
#include "tsr/host/recorded_frames.h"

namespace tsr
{

namespace
{

constexpr std::uint16_t kGatewayId = 1;
constexpr std::uint16_t kCameraId = 2;
constexpr std::uint32_t kPeriodMs = 500;

/* A fifth of the width, as in most indoor rigs, in the matcher's steps of 8. */
int default_disparities(int width)
{
    return std::clamp((width / 5 + 7) / 8 * 8, 16, 128);
}

} // namespace

Site make_pair_site(const PairOptions &options)
{
    const RecordedFrames left(options.left, kPeriodMs);
    const RecordedFrames right(options.right, kPeriodMs);
    if (left.size() != right.size()) {
        throw InputError(options.right.string(), "size", "is not that of the left frames");
    }
    Site site;
    site.file = "--pair";
    site.name = "pair";
    site.seed = options.seed;
    SiteNode gateway;
    gateway.id = kGatewayId;
    gateway.name = "gateway";
    gateway.role = Role::gateway;
    SiteNode camera;
    camera.id = kCameraId;
    camera.name = "camera";
    camera.role = Role::binocular;
    camera.parent = kGatewayId;
    camera.position_m = {10, 0, 0};
    camera.frames = std::filesystem::absolute(options.left);
    camera.frames_right = std::filesystem::absolute(options.right);
    camera.watch_period_ms = kPeriodMs;
    site.nodes = {gateway, camera};
    SitePair pair;
    pair.name = "pair";
    pair.lead = kCameraId;
    pair.width = left.size().width;
    pair.height = left.size().height;
    pair.disparities = options.disparities > 0 ? options.disparities : default_disparities(pair.width);
    pair.d0_px = options.d0_px;
    pair.focal_px = options.focal_px;
    pair.baseline_mm = options.baseline_mm;
    /* Looking along the site's y axis, z up: camera z to site y, camera y down. */
    pair.left.rotation = {1, 0, 0, 0, 0, 1, 0, -1, 0};
    pair.principal_px = {(pair.width - 1) / 2.0, (pair.height - 1) / 2.0};
    site.pairs = {pair};
    check_site(site);
    return site;
}

} // namespace tsr

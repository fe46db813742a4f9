/*
 * Embree 3 (Debian 12) and 4 (Debian 13, Ubuntu 24.04), whose calls differ in
 * where a ray's context goes.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENE_EMBREE_H
#define TSR_SCENE_EMBREE_H

#if TSR_EMBREE_VERSION >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace tsr::scene
{

/* rayhit becomes the nearest of what it holds and what is met in scene. */
inline void intersect(RTCScene scene, RTCRayHit &rayhit)
{
#if TSR_EMBREE_VERSION >= 4
    rtcIntersect1(scene, &rayhit);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &rayhit);
#endif
}

/* ray.tfar is below 0 afterwards if anything is met. */
inline void occlude(RTCScene scene, RTCRay &ray)
{
#if TSR_EMBREE_VERSION >= 4
    rtcOccluded1(scene, &ray);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &ray);
#endif
}

} // namespace tsr::scene

#endif

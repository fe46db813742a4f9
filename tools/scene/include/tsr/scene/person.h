/*
 * People: ten rigid parts that walk, sit and lie.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENE_PERSON_H
#define TSR_SCENE_PERSON_H

#include <string>
#include <vector>

#include "tsr/scene/path.h"

namespace tsr::scene
{

enum class Posture {
    standing, /* and walking, when the place changes */
    sitting,  /* on a seat 0.45 m high */
    lying     /* on the back, on the ground; heading is from hip to head */
};

struct PersonKey {
    double time_s = 0;
    float x = 0, y = 0; /* of the hip, m; the ground is z = ground_m */
    float heading_deg = 0;
    Posture posture = Posture::standing; /* changes evenly from key to key */
    float rise_m = 0;                    /* of the ground here, above PersonOptions::ground_m: a kerb, a step */
};

struct Clothes {
    SurfaceId skin = 0, hair = 0, top = 0, trousers = 0;
};

struct PersonOptions {
    float height_m = 1.75F;
    float ground_m = 0;
    bool stays = false; /* there before the first key and after the last */
};

/* Adds a person to world; keys in order of time, at least one. */
ObjectId add_person(World &world, const std::string &name, const std::vector<PersonKey> &keys, const Clothes &clothes,
                    const PersonOptions &options);

/* Cloth, skin and hair that no two seeds give alike. */
Clothes make_clothes(World &world, std::uint32_t seed);

} // namespace tsr::scene

#endif

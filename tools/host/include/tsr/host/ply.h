/*
 * Point clouds as binary little-endian PLY (Greg Turk, Stanford, 1994):
 * float x y z in metres, uchar red green blue.
 *
 * A cloud of a thousand pairs has hundreds of megabytes, so nobody needs to
 * hold it: it is written in parts, and a sample of it can be read.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_PLY_H
#define TSR_HOST_PLY_H

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "tsr/host/atomic_file.h"

namespace tsr
{

struct CloudPoint {
    float x_m = 0;
    float y_m = 0;
    float z_m = 0;
    std::uint8_t red = 0;
    std::uint8_t green = 0;
    std::uint8_t blue = 0;
    bool operator==(const CloudPoint &) const = default;
};

/* The order of the points is kept. All throw InputError if file cannot be written; it is there once it is complete. */
class PlyWriter
{
  public:
    /* count: of all points; the header, which comes first, says it. */
    PlyWriter(const std::filesystem::path &file, std::size_t count);

    void add(std::span<const CloudPoint> points);
    /* Throws std::logic_error unless count points were added. Call last. */
    void complete();

  private:
    AtomicFile out_;
    std::size_t missing_;
    std::vector<std::uint8_t> bytes_; /* of one add() */
};

struct PlySample {
    std::size_t of = 0; /* points in the file */
    std::vector<CloudPoint> points;
};

/* At most so many points of a file of PlyWriter, evenly in its order. Throws InputError for any other file. */
PlySample sample_ply(const std::filesystem::path &file, std::size_t most);

} // namespace tsr

#endif

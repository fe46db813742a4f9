/* Fit, bytes and error of a rectification table. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/rectify_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include <Eigen/Dense>

#include "tsr/host/input_error.h"

extern "C" {
#include "tsr/base/bytes.h"
#include "tsr/base/crc.h"
#include "tsr/vision/rectify.h"
}

namespace tsr
{
namespace
{

constexpr double kPointScale = 1 << TSR_RECTIFY_POINT_FRACTION_BITS;
constexpr std::size_t kRowsAboveAt = 14; /* in the header */
constexpr double kFarOutside = 10000;    /* px: beyond that a position says "outside" and no more */

/* Rows: positions 0 .. spans S; columns: control points. One more position than
 * the last span has, so that the last point is determined however the side ends. */
Eigen::MatrixXd spline_matrix(int length, int step)
{
    const int spans = (length + step - 1) / step;
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(spans * step + 1, spans + 3);
    for (int x = 0; x <= spans * step; x++) {
        const int span = std::min(x / step, spans - 1);
        const double t = static_cast<double>(x - span * step) / step;
        const double s = 1 - t;
        matrix(x, span) = s * s * s / 6;
        matrix(x, span + 1) = (3 * t * t * t - 6 * t * t + 4) / 6;
        matrix(x, span + 2) = (3 * s * s * s - 6 * s * s + 4) / 6;
        matrix(x, span + 3) = t * t * t / 6;
    }
    return matrix;
}

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd &matrix)
{
    return (matrix.transpose() * matrix).ldlt().solve(matrix.transpose());
}

double bounded(double position)
{
    return std::isfinite(position) ? std::clamp(position, -kFarOutside, kFarOutside) : kFarOutside;
}

/* points[axis](row, column) in px. */
std::array<Eigen::MatrixXd, 2> fit_points(const Rectification &rectification, bool right, int step)
{
    const Eigen::MatrixXd across = spline_matrix(rectification.output.width, step);
    const Eigen::MatrixXd down = spline_matrix(rectification.output.height, step);
    std::array<Eigen::MatrixXd, 2> positions;
    positions.fill(Eigen::MatrixXd(down.rows(), across.rows()));
    for (Eigen::Index y = 0; y < down.rows(); y++) {
        for (Eigen::Index x = 0; x < across.rows(); x++) {
            const Point2 seen = rectification.source_position(right, {static_cast<double>(x), static_cast<double>(y)});
            positions[0](y, x) = bounded(seen.x);
            positions[1](y, x) = bounded(seen.y);
        }
    }
    const Eigen::MatrixXd from_rows = pseudo_inverse(down);
    const Eigen::MatrixXd from_columns = pseudo_inverse(across).transpose();
    return {from_rows * positions[0] * from_columns, from_rows * positions[1] * from_columns};
}

std::uint16_t point_value(double position, int middle)
{
    const double value = std::round((position - middle) * kPointScale);
    return static_cast<std::uint16_t>(
        static_cast<std::int16_t>(std::clamp(value, static_cast<double>(std::numeric_limits<std::int16_t>::min()),
                                             static_cast<double>(std::numeric_limits<std::int16_t>::max()))));
}

std::uint32_t q16(double value)
{
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::llround(value * 65536)));
}

void write_header(tsr_writer &writer, const Rectification &rectification, int step_log2,
                  const std::array<std::uint16_t, 2> &rows_above)
{
    const std::uint8_t magic[] = {'T', 'S', 'R', 'M'};
    tsr_write_span(&writer, magic, sizeof magic);
    tsr_write_u8(&writer, TSR_RECTIFY_VERSION);
    tsr_write_u8(&writer, static_cast<std::uint8_t>(step_log2));
    for (const ImageSize size : {rectification.output, rectification.source()}) {
        tsr_write_u16(&writer, static_cast<std::uint16_t>(size.width));
        tsr_write_u16(&writer, static_cast<std::uint16_t>(size.height));
    }
    tsr_write_u16(&writer, rows_above[0]);
    tsr_write_u16(&writer, rows_above[1]);
    tsr_write_u16(&writer, static_cast<std::uint16_t>(std::lround(rectification.d0_px() * 16)));
    tsr_write_u16(&writer, 0);
    tsr_write_u32(&writer, q16(rectification.views.focal_px));
    tsr_write_u32(&writer, q16(rectification.views.baseline_mm));
    tsr_write_u32(&writer, q16(rectification.views.cx_left));
    tsr_write_u32(&writer, q16(rectification.views.cy));
}

std::vector<std::uint8_t> write_table(const Rectification &rectification, int step_log2,
                                      std::array<std::uint16_t, 2> &rows_above)
{
    const ImageSize output = rectification.output;
    const ImageSize source = rectification.source();
    std::vector<std::uint8_t> bytes(TSR_RECTIFY_TABLE_LEN(output.width, output.height, step_log2));
    tsr_writer writer = tsr_writer_make(bytes.data(), bytes.size());
    write_header(writer, rectification, step_log2, {0, 0});
    tsr_rectify_table table{};
    table.width = static_cast<std::uint16_t>(output.width);
    table.height = static_cast<std::uint16_t>(output.height);
    table.source_width = static_cast<std::uint16_t>(source.width);
    table.source_height = static_cast<std::uint16_t>(source.height);
    table.step_log2 = static_cast<std::uint8_t>(step_log2);
    for (int side = 0; side < 2; side++) {
        table.grid[side] = bytes.data() + writer.at;
        const auto points = fit_points(rectification, side == 1, 1 << step_log2);
        for (Eigen::Index row = 0; row < points[0].rows(); row++) {
            for (Eigen::Index column = 0; column < points[0].cols(); column++) {
                tsr_write_u16(&writer, point_value(points[0](row, column), source.width / 2));
                tsr_write_u16(&writer, point_value(points[1](row, column), source.height / 2));
            }
        }
        rows_above[side] = tsr_rectify_measure_rows_above(&table, static_cast<tsr_rectify_side>(side));
    }
    tsr_writer rows_writer = tsr_writer_make(bytes.data() + kRowsAboveAt, 4);
    tsr_write_u16(&rows_writer, rows_above[0]);
    tsr_write_u16(&rows_writer, rows_above[1]);
    tsr_write_u16(&writer,
                  static_cast<std::uint16_t>(tsr_crc16(TSR_CRC16_START_HDLC, bytes.data(), writer.at) ^ 0xffffu));
    return bytes;
}

void measure(RectifyTable &made, const Rectification &rectification)
{
    tsr_rectify_table table;
    if (const tsr_status status = tsr_rectify_open(&table, made.bytes.data(), made.bytes.size()); status != TSR_OK) {
        throw std::logic_error(std::string("the rectification table does not open: ") + tsr_status_name(status));
    }
    const ImageSize source = rectification.source();
    for (int side = 0; side < 2; side++) {
        std::size_t outside = 0;
        for (int y = 0; y < table.height; y++) {
            for (int x = 0; x < table.width; x++) {
                const Point2 seen =
                    rectification.source_position(side == 1, {static_cast<double>(x), static_cast<double>(y)});
                const double seen_x = std::clamp(bounded(seen.x), 0.0, source.width - 1.0);
                const double seen_y = std::clamp(bounded(seen.y), 0.0, source.height - 1.0);
                outside += seen_x != seen.x || seen_y != seen.y ? 1 : 0;
                std::int32_t read[2];
                tsr_rectify_position(&table, static_cast<tsr_rectify_side>(side), static_cast<std::uint16_t>(x),
                                     static_cast<std::uint16_t>(y), read);
                made.error_px[side] =
                    std::max(made.error_px[side], std::hypot(read[0] / 256.0 - seen_x, read[1] / 256.0 - seen_y));
            }
        }
        made.outside[side] = static_cast<double>(outside) / (static_cast<double>(table.width) * table.height);
        made.rows_above[side] = table.rows_above[side];
        if (source == rectification.output) {
            made.kept_len = std::max(made.kept_len, TSR_RECTIFY_KEPT_LEN(table.width, table.rows_above[side]));
        }
    }
}

RectifyTable make_one(const Rectification &rectification, int step_log2)
{
    RectifyTable made;
    std::array<std::uint16_t, 2> rows_above{};
    made.step = 1 << step_log2;
    made.bytes = write_table(rectification, step_log2, rows_above);
    measure(made, rectification);
    return made;
}

} // namespace

RectifyTable make_rectify_table(const Rectification &rectification, int step, const std::string &file)
{
    RectifyTable made;
    double error = std::numeric_limits<double>::infinity();
    for (int step_log2 = TSR_RECTIFY_STEP_LOG2_MAX; step_log2 >= TSR_RECTIFY_STEP_LOG2_MIN; step_log2--) {
        if (step != 0 && step != 1 << step_log2) {
            continue;
        }
        made = make_one(rectification, step_log2);
        error = std::max(made.error_px[0], made.error_px[1]);
        if (error <= kRectifyErrorAimPx) {
            break;
        }
    }
    if (!(error <= kRectifyErrorMaxPx)) {
        char reason[160];
        std::snprintf(reason, sizeof reason,
                      "the table misses the map by up to %.3f px, more than %.2f: use a smaller --step, or --zoom 0",
                      error, kRectifyErrorMaxPx);
        throw InputError(file, "--step", reason);
    }
    return made;
}

std::string rectify_c_header(const RectifyTable &table, const Rectification &rectification, const std::string &name)
{
    std::string upper = name;
    std::transform(upper.begin(), upper.end(), upper.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    const std::string guard = upper + "_H";
    std::string text =
        "/* A rectification table for tsr/vision/rectify.h, made by tarsier rectify-table. */\n#ifndef " + guard +
        "\n#define " + guard + "\n\n#include <stdint.h>\n\n";
    const auto define = [&](const char *what, std::size_t value) {
        text += "#define " + upper + "_" + what + " " + std::to_string(value) + "u\n";
    };
    define("WIDTH", static_cast<std::size_t>(rectification.output.width));
    define("HEIGHT", static_cast<std::size_t>(rectification.output.height));
    define("KEPT_LEN", table.kept_len); /* bytes for tsr_rectify_start_in_place; 0: another frame is needed */
    text += "\nstatic const uint8_t " + name + "[" + std::to_string(table.bytes.size()) + "] = {";
    for (std::size_t i = 0; i < table.bytes.size(); i++) {
        char byte[8];
        std::snprintf(byte, sizeof byte, "0x%02x,", static_cast<unsigned>(table.bytes[i]));
        text += (i % 16 == 0 ? "\n    " : " ") + std::string(byte);
    }
    return text + "\n};\n\n#endif\n";
}

} // namespace tsr

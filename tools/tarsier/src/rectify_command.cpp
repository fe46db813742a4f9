/* The table of a calibration, and its numbers. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/stage/rectify_command.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

#include <nlohmann/json.hpp>

#include "tsr/host/atomic_file.h"
#include "tsr/host/calibration.h"
#include "tsr/host/input_error.h"
#include "tsr/host/output_files.h"
#include "tsr/host/rectification.h"
#include "tsr/host/rectify_table.h"

namespace tsr
{
namespace
{

ImageSize parse_size(const std::string &text, const std::string &option)
{
    if (text.empty()) {
        return {};
    }
    ImageSize size;
    char after = 0;
    if (std::sscanf(text.c_str(), "%5dx%5d%c", &size.width, &size.height, &after) != 2 || size.width < 1 ||
        size.height < 1) {
        throw InputError("command line", option, "'" + text + "' is not WIDTHxHEIGHT");
    }
    return size;
}

RectifyOptions rectify_options(const RectifyTableOptions &options)
{
    if ((options.width == 0) != (options.height == 0)) {
        throw InputError("command line", "--width, --height", "give both or none");
    }
    if (options.zoom && !(*options.zoom >= 0 && *options.zoom <= 1)) {
        throw InputError("command line", "--zoom", "takes 0 .. 1");
    }
    if (options.unit_mm && !(*options.unit_mm > 0 && std::isfinite(*options.unit_mm))) {
        throw InputError("command line", "--unit-mm", "takes a number above 0");
    }
    RectifyOptions chosen;
    chosen.output = {options.width, options.height};
    chosen.source = parse_size(options.source, "--source");
    chosen.zoom = options.zoom;
    chosen.separate_centres = options.separate_centres;
    return chosen;
}

/* A C identifier from the header's file name. */
std::string c_name(const std::filesystem::path &file)
{
    std::string name = file.stem().string();
    for (char &c : name) {
        const bool word = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        c = word ? c : '_';
    }
    return name.empty() || (name[0] >= '0' && name[0] <= '9') ? "table_" + name : name;
}

nlohmann::ordered_json as_json(const StereoCalibration &calibration, const Rectification &rectification,
                               const RectifyTable &table)
{
    const RectifiedViews &views = rectification.views;
    return {{"format", calibration.format},
            {"width", rectification.output.width},
            {"height", rectification.output.height},
            {"source_width", rectification.source().width},
            {"source_height", rectification.source().height},
            {"focal_px", views.focal_px},
            {"baseline_mm", views.baseline_mm},
            {"principal_px", {views.cx_left, views.cy}},
            {"d0_px", rectification.d0_px()},
            {"rotation_left", views.rotation_left},
            {"rotation_right", views.rotation_right},
            {"step_px", table.step},
            {"table_bytes", table.bytes.size()},
            {"error_px", table.error_px},
            {"rows_above", table.rows_above},
            {"kept_bytes", table.kept_len},
            {"outside", table.outside}};
}

void print_toml(const StereoCalibration &calibration, const Rectification &rectification, const RectifyTable &table)
{
    const RectifiedViews &views = rectification.views;
    std::printf("# %s calibration; for [[pair]] in site.toml:\n", calibration.format.c_str());
    std::printf("width = %d\nheight = %d\n", rectification.output.width, rectification.output.height);
    std::printf("focal_px = %.4f\nbaseline_mm = %.4f\n", views.focal_px, views.baseline_mm);
    std::printf("principal_px = [%.4f, %.4f]\nd0_px = %.4f\n", views.cx_left, views.cy, rectification.d0_px());
    std::printf("# table: %zu bytes, step %d px, largest error %.4f px (left) and %.4f px (right)\n",
                table.bytes.size(), table.step, table.error_px[0], table.error_px[1]);
    std::printf("# outside the camera's frame: %.2f %% (left) and %.2f %% (right) of the view\n",
                100 * table.outside[0], 100 * table.outside[1]);
    if (table.kept_len > 0) {
        std::printf("# in place: %d and %d rows above, %zu bytes of kept rows\n", table.rows_above[0],
                    table.rows_above[1], table.kept_len);
    }
}

void check_files(const RectifyTableOptions &options)
{
    std::vector<OutputFile> outputs = {{options.table, "--out"}};
    if (!options.c_header.empty()) {
        outputs.push_back({options.c_header, "--c-header"});
    }
    check_outputs(outputs, options.calibration);
}

} // namespace

void write_rectify_table(const RectifyTableOptions &options)
{
    check_files(options);
    const RectifyOptions chosen = rectify_options(options);
    CalibrationUnits units;
    units.size = parse_size(options.calibrated, "--calibrated");
    units.unit_mm = options.unit_mm.value_or(0.0);
    const StereoCalibration calibration = read_calibration(options.calibration, units);
    if (!options.calibrated.empty() && calibration.left.size != units.size) {
        throw InputError("command line", "--calibrated",
                         calibration.file + " says " + std::to_string(calibration.left.size.width) + "x" +
                             std::to_string(calibration.left.size.height));
    }
    const Rectification rectification = rectify_calibration(calibration, chosen);
    const RectifyTable table = make_rectify_table(rectification, options.step, calibration.file);
    if (!options.c_header.empty()) {
        write_file_atomically(options.c_header, rectify_c_header(table, rectification, c_name(options.c_header)));
    }
    EarlierOutput header(options.c_header);
    write_file_atomically(options.table, std::span<const std::uint8_t>(table.bytes));
    header.keep();
    if (options.json) {
        std::cout << as_json(calibration, rectification, table).dump(2) << '\n';
    } else {
        print_toml(calibration, rectification, table);
    }
}

} // namespace tsr

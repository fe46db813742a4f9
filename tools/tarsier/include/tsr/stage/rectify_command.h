/*
 * tarsier rectify-table: from a calibration to a table and the lines of site.toml.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_STAGE_RECTIFY_COMMAND_H
#define TSR_STAGE_RECTIFY_COMMAND_H

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tsr
{

struct RectifyTableOptions {
    std::vector<std::filesystem::path> calibration;
    std::filesystem::path table;
    std::filesystem::path c_header; /* empty: none */
    int width = 0;                  /* px; 0: the calibrated size */
    int height = 0;
    std::string source;     /* "WIDTHxHEIGHT"; empty: width x height */
    std::string calibrated; /* for files that do not say it */
    int step = 0;
    std::optional<double> zoom;
    bool separate_centres = false;
    std::optional<double> unit_mm; /* none: the format's own */
    bool json = false;
};

/* Writes the table and prints what site.toml needs. Throws InputError; then
 * nothing was written. */
void write_rectify_table(const RectifyTableOptions &options);

} // namespace tsr

#endif

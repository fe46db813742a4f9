/*
 * A command's outputs, before anything is read or written.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_OUTPUT_FILES_H
#define TSR_HOST_OUTPUT_FILES_H

#include <filesystem>
#include <span>
#include <string>

namespace tsr
{

struct OutputFile {
    std::filesystem::path file; /* empty: not asked for */
    std::string option;
};

/* Throws InputError naming the output and its option if it is one of the inputs, or the same file as an output before
 * it, by whatever way it is named. */
void check_output_files(std::span<const OutputFile> outputs, std::span<const std::filesystem::path> inputs);

} // namespace tsr

#endif

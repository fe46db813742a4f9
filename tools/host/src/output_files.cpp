/*
 * Outputs that would destroy an input or each other.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/host/output_files.h"

#include <algorithm>

#include "tsr/host/input_error.h"

namespace tsr
{
namespace
{

namespace fs = std::filesystem;

bool is_same_file(const fs::path &a, const fs::path &b)
{
    std::error_code error;
    if (fs::equivalent(a, b, error) && !error) {
        return true;
    }
    /* What does not exist yet is resolved as far as it does, which needs a whole path. */
    error.clear();
    return fs::weakly_canonical(fs::absolute(a), error) == fs::weakly_canonical(fs::absolute(b), error) && !error;
}

} // namespace

void check_output_files(std::span<const OutputFile> outputs, std::span<const fs::path> inputs)
{
    for (std::size_t i = 0; i < outputs.size(); i++) {
        const OutputFile &output = outputs[i];
        if (output.file.empty()) {
            continue;
        }
        if (std::any_of(inputs.begin(), inputs.end(),
                        [&](const fs::path &input) { return is_same_file(output.file, input); })) {
            throw InputError(output.file.string(), output.option, "is an input");
        }
        for (const OutputFile &other : outputs.first(i)) {
            if (!other.file.empty() && is_same_file(output.file, other.file)) {
                throw InputError(output.file.string(), output.option, "is the same file as " + other.option);
            }
        }
    }
}

} // namespace tsr

/* Outputs against inputs. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/output_files.h"

#include "tsr/host/input_error.h"
#include "tsr/host/paths.h"

namespace tsr
{
namespace
{

namespace fs = std::filesystem;

bool is_same_file(const fs::path &a, const fs::path &b)
{
    return !a.empty() && !b.empty() && real_path(a) == real_path(b);
}

} // namespace

void check_outputs(const std::vector<OutputFile> &outputs, const std::vector<fs::path> &inputs)
{
    for (std::size_t i = 0; i < outputs.size(); i++) {
        for (const fs::path &input : inputs) {
            if (is_same_file(outputs[i].file, input)) {
                throw InputError(outputs[i].file.string(), outputs[i].option, "is an input");
            }
        }
        for (std::size_t earlier = 0; earlier < i; earlier++) {
            if (is_same_file(outputs[i].file, outputs[earlier].file)) {
                throw InputError(outputs[i].file.string(), outputs[i].option,
                                 std::string("is the same file as ") + outputs[earlier].option);
            }
        }
    }
}

std::string refuse_empty_name(const std::string &name)
{
    return name.empty() ? "the name is empty" : "";
}

EarlierOutput::~EarlierOutput()
{
    if (!file_.empty()) {
        std::error_code ignored;
        fs::remove(file_, ignored);
    }
}

} // namespace tsr

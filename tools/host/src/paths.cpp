/* Paths without links. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/paths.h"

#include <algorithm>
#include <system_error>

#include "tsr/host/input_error.h"

namespace tsr
{

namespace fs = std::filesystem;

fs::path real_path(const fs::path &path)
{
    /* Absolute first: weakly_canonical() leaves a relative name as it is where nothing of it exists. */
    std::error_code error;
    const fs::path absolute = fs::absolute(path, error);
    const fs::path real = error ? fs::path() : fs::weakly_canonical(absolute, error);
    if (error) {
        throw InputError(path.string(), "path", error.message());
    }
    return real.has_filename() ? real : real.parent_path(); /* "a/" is "a", "/" is "/" */
}

bool lies_within(const fs::path &path, const fs::path &folder)
{
    const fs::path inner = real_path(path), outer = real_path(folder);
    const fs::path below_root = outer.relative_path(); /* "/" has a root and no names */
    const fs::path names = inner.relative_path();
    return std::mismatch(below_root.begin(), below_root.end(), names.begin(), names.end()).first == below_root.end();
}

} // namespace tsr

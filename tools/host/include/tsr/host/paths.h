/*
 * Where a path leads once symbolic links are followed.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_PATHS_H
#define TSR_HOST_PATHS_H

#include <filesystem>

namespace tsr
{

/*
 * path without links, "." and "..": the part that exists as the file system
 * has it, what is missing below as it is written. No slash at its end.
 * Throws InputError "PATH: path: reason": links in a circle, a name too long,
 * a folder that may not be searched.
 */
std::filesystem::path real_path(const std::filesystem::path &path);

/*
 * path is folder or something below it, as real_path() sees both: whoever
 * removes folder removes path. Neither needs to exist. A hard link to a file
 * below folder is not below it. Throws as real_path().
 */
bool lies_within(const std::filesystem::path &path, const std::filesystem::path &folder);

} // namespace tsr

#endif

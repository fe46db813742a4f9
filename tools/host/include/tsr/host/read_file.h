/*
 * A whole file in memory, with a limit.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_READ_FILE_H
#define TSR_HOST_READ_FILE_H

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tsr
{

inline constexpr std::size_t kReadFileMax = std::size_t{1} << 30;

/* Throws InputError if file cannot be read, is not a regular file or holds
 * more than max_len bytes. */
std::vector<std::uint8_t> read_file(const std::filesystem::path &file, std::size_t max_len = kReadFileMax);
std::string read_text_file(const std::filesystem::path &file, std::size_t max_len = kReadFileMax);

} // namespace tsr

#endif

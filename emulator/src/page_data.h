/* Data for pages: private to emulator/src. SPDX-License-Identifier: Apache-2.0 */
#ifndef TSR_EMULATOR_PAGE_DATA_H
#define TSR_EMULATOR_PAGE_DATA_H

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace tsr
{

/* RFC 4648, section 4. */
std::string base64(std::span<const std::uint8_t> bytes);

/* Points of the PLY file that the sink wrote, thinned evenly and on a grid: see page.cpp. Throws InputError. */
nlohmann::ordered_json cloud_json(const std::filesystem::path &file);

/* A page of page_template.h with data in the place of its mark; whole numbers above 2^53, as seeds are, become texts.
 */
std::string filled_page(std::span<const std::string_view> page, nlohmann::ordered_json data);

} // namespace tsr

#endif

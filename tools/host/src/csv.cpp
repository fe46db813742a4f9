/* Fields of CSV files. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/csv.h"

namespace tsr
{

std::string csv_field(std::string_view text)
{
    if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
        return std::string(text);
    }
    std::string field = "\"";
    for (const char c : text) {
        field += c;
        if (c == '"') {
            field += c;
        }
    }
    return field + "\"";
}

} // namespace tsr

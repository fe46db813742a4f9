/*
 * Fields of CSV files, RFC 4180.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_CSV_H
#define TSR_HOST_CSV_H

#include <string>
#include <string_view>

namespace tsr
{

/* text as a field: in quotation marks if it has a comma, a quotation mark or a line's end. */
std::string csv_field(std::string_view text);

} // namespace tsr

#endif

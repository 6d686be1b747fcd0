// SPDX-License-Identifier: Apache-2.0
// A line of key=value, as log_value makes them, as one JSON object.
#pragma once

#include <string>
#include <string_view>

namespace weft::server {

// Keys in the order of the line. A value is a number where it is written as JSON writes numbers,
// text otherwise; bytes that are no UTF-8 are replaced. A line of any other form becomes
// {"message": LINE}.
std::string json_of_fields(std::string_view line);

// Whether the text is a number of JSON.
bool is_number(std::string_view text);

}  // namespace weft::server

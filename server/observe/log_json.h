// SPDX-License-Identifier: Apache-2.0
// Converts a line of key=value, as log_value makes them, to a JSON object.
#pragma once

#include <string>
#include <string_view>

namespace weft::server {

// Keys are in the order of the line. A value is a number if it has the form of a JSON number,
// otherwise a string; bytes that are not UTF-8 are replaced. A line of any other form becomes
// {"message": LINE}.
std::string json_of_fields(std::string_view line);

// Whether the text is a JSON number.
bool is_number(std::string_view text);

}  // namespace weft::server

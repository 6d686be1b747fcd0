// SPDX-License-Identifier: Apache-2.0
// Formats numbers and strings for people.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace weft::files {

// 'text', shortened to 32 bytes; bytes that are not printable ASCII become \xNN.
std::string in_quotes(std::string_view text);
// "'a', 'b'"; after 24 of them "...".
std::string in_quotes(const std::vector<std::string>& texts);

// A server's text, safe for a terminal: control characters except line feeds become '?'.
std::string harmless(std::string_view text);

// The shortest text that reads back as the same number.
std::string shortest(double value);

// "(x, y)" in shortest numbers.
std::string coordinates(double x, double y);

// 1234567 as "1,234,567".
std::string with_separators(std::uint64_t value);

// With so many significant digits, such as "1.23e+06" with 3.
std::string digits(double value, int count);

// The next number of two digits, such as "0.016" above 0.0156 and "0.011" above 0.01. REQUIRES: the
// value is finite and above 0.
std::string two_digits_above(double value);

// Seconds as "0.083 s", bytes as "39.7 MB".
std::string seconds_text(double seconds);
std::string bytes_text(std::uint64_t bytes);

// Lower-case hexadecimal.
std::string hex(std::string_view bytes);

}  // namespace weft::files

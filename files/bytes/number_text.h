// SPDX-License-Identifier: Apache-2.0
// Numbers as programs write them in text. A text is a number as a whole or not at all: no number is
// read from the beginning of "4.0x".
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace weft::files {

// A finite number: decimal, with or without an exponent, which begins with e, E, or Fortran's d or
// D. As Fortran leaves the letter out before three digits of an exponent, "1.0+103" is 1.0e103. A
// number too small for a double is 0, one that is too large is none.
std::optional<double> real_of(std::string_view text);

// The same, in which a comma is the decimal mark: "0,5".
std::optional<double> real_with_comma_of(std::string_view text);

// A whole number of 64 bits, "+3" among them.
std::optional<std::int64_t> integer_of(std::string_view text);

// The same, also as programs write it that write all numbers as reals: "3.0", "3.000e+00".
std::optional<std::int64_t> whole_of(std::string_view text);

}  // namespace weft::files

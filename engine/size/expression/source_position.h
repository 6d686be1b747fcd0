// SPDX-License-Identifier: Apache-2.0
// Describes where an expression has an error.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace weft::expr {

// "line 1, column 7". Lines and columns count from 1, columns in bytes.
std::string position(std::string_view source, std::size_t offset);

// "line 1, column 7: WHAT", then the source's line and a caret under the offset. Only
// the surroundings in a long line are shown; bytes that are not printable ASCII become '?', so the
// text is valid UTF-8 for any source.
std::string describe(std::string_view source, std::size_t offset, std::string_view what);

// A name from the source, made printable and shortened to fit on a line, to be quoted.
std::string quoted(std::string_view text);

}  // namespace weft::expr

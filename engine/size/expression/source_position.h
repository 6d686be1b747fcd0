// SPDX-License-Identifier: Apache-2.0
// Says where in an expression something is wrong.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace weft::expr {

// "line 1, column 7". Lines and columns count from 1, columns in bytes.
std::string position(std::string_view source, std::size_t offset);

// "line 1, column 7: WHAT", then the source's line and a caret under the offset. Only
// the surroundings of a long line are shown; what is not printable ASCII shows as '?', so the text
// is valid UTF-8 whatever the source holds.
std::string describe(std::string_view source, std::size_t offset, std::string_view what);

// A name from the source, made fit to be quoted: printable, and no longer than a line can bear.
std::string quoted(std::string_view text);

}  // namespace weft::expr

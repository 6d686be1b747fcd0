// SPDX-License-Identifier: Apache-2.0
// Texts of dBASE tables, whose encoding a file beside the table or a byte of its header names.
#pragma once

#include <string>
#include <string_view>

namespace weft::files {

// The text as UTF-8. `code_page` as Shapelib's DBFGetCodePage has it: the contents of the .cpg file
// ("1252", "ISO-8859-1", "ANSI 1252"), or "LDID/" and the language driver of the header; if it is
// empty or says nothing, Windows-1252. A text that is UTF-8, or that the code page does not
// explain, stays as it is.
std::string to_utf8(const std::string& text, std::string_view code_page);

}  // namespace weft::files

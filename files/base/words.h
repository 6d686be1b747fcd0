// SPDX-License-Identifier: Apache-2.0
// Words of a text, in ASCII whatever the locale.
#pragma once

#include <string>
#include <string_view>

namespace weft::files {

// Without the blanks around it.
std::string_view trimmed(std::string_view text);

// Letters in lower case, the rest as it is.
std::string lower_case(std::string_view text);

}  // namespace weft::files

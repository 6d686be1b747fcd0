// SPDX-License-Identifier: Apache-2.0
// The version of the server, from the project's CMakeLists.txt.
#pragma once

#include <string_view>

namespace weft::server {

inline constexpr std::string_view kVersion = WEFT_VERSION;

}  // namespace weft::server

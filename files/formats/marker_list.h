// SPDX-License-Identifier: Apache-2.0
// Markers of a domain, some of which may be given by name: "2,inlet".
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "files/base/error.h"
#include "files/formats/names.h"

namespace weft::files {

struct MarkerList {
  std::vector<std::int32_t> markers{};
  std::vector<std::string> names{};

  // nullopt: one of them is empty.
  static std::optional<MarkerList> parse(const std::string& text);
  // All as numbers, those of names last. Errors: kUsage for a name that is none of these.
  Result<std::vector<std::int32_t>> numbers(const NameTable& names_of_markers) const;
};

}  // namespace weft::files

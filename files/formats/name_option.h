// SPDX-License-Identifier: Apache-2.0
// A name for a marker or a region, as a caller says it: one --names.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <tl/expected.hpp>

#include "files/base/error.h"
#include "files/formats/names.h"

namespace weft::files {

struct NameOption {
  NameKind kind = NameKind::kMarker;
  std::int32_t id = 0;
  std::string name;

  // `text` is marker=2:inlet or region=1:fluid. The error is a text that says what is wrong.
  static tl::expected<NameOption, std::string> parse(const std::string& text);
};

// Sets the names; one of an id that has a name already replaces it. Error: kUsage if two ids would
// have the same name.
Result<void> set_names(std::span<const NameOption> options, Names& names);

}  // namespace weft::files

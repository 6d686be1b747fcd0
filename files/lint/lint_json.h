// SPDX-License-Identifier: Apache-2.0
// The faults of a domain for programs.
#pragma once

#include <nlohmann/json.hpp>

#include "files/lint/domain_lint.h"

namespace weft::files {

nlohmann::ordered_json lint_json(const Lint& lint);

// What a finding has besides its place.
nlohmann::ordered_json properties_of(const Finding& finding);
// [x, y]
nlohmann::ordered_json position(Point p);

}  // namespace weft::files

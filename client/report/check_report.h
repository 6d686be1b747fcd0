// SPDX-License-Identifier: Apache-2.0
// What `weft check` prints: for people a sentence about each property that was judged, with rounded
// figures; for programs the checker's own figures.
//
// This folder has more than 25 files because each report has its own.
#pragma once

#include <string>

#include "checker/check.h"
#include "client/report/json_line.h"

namespace weft::client {

// One line per rule ("angles at least 24.53 degrees, 20 required: holds"), and the violations of
// those that fail below them; the last line is "the mesh holds" or "the mesh fails". Rounding never
// hides a failure: a figure that misses its bound has as many digits as it takes to tell them
// apart.
std::string check_text(const check::Report& report, const check::Requirements& requirements);

// {"holds": true, "vertices": 3156, ..., "rules": {"domain": {"judged": true, "violations": 0},
// ...}, "violations": [{"rule": ..., "sentence": ...}]}; lengths in the unit of the mesh.
Json check_json(const check::Report& report, const check::Requirements& requirements);

}  // namespace weft::client

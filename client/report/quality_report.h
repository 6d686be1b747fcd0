// SPDX-License-Identifier: Apache-2.0
// What `weft info --quality` prints.
#pragma once

#include <string>

#include "client/report/json_line.h"
#include "client/report/mesh_quality.h"

namespace weft::client {

// Histograms of bars, and the worst triangles. `unicode`: bars of block elements in UTF-8, else of
// '#'.
std::string quality_text(const MeshQuality& quality, bool unicode);

// The figures, {"histograms": {"min_angle_deg": {"bounds": [0, 5, ...], "counts": [...]}, ...},
// "worst": {"by_angle": [{"triangle": 7, "at": [x, y], ...}], ...}}; an infinite bound, or aspect,
// is null.
Json quality_json(const MeshQuality& quality);

// Whether the environment says that text is UTF-8 (LC_ALL, else LC_CTYPE, else LANG).
bool locale_is_utf8();

}  // namespace weft::client

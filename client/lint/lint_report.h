// SPDX-License-Identifier: Apache-2.0
// What `weft lint` prints, writes and draws.
#pragma once

#include <string>

#include "client/drawing/draw.h"
#include "client/report/json_line.h"
#include "files/base/atomic_file.h"
#include "files/formats/domain.h"
#include "files/lint/domain_lint.h"
#include "files/lint/lint_json.h"

namespace weft::client {

// A line for each finding, at most 20 of a kind, and one that counts.
std::string lint_text(const Lint& lint);

// A layer for geographic information systems: a point or a line for each finding.
void write_lint_layer(const Lint& lint, OutputFile& file);

// The domain's segments, and a ring around each finding, numbered by kind.
void draw_lint(const Domain& domain, const Lint& lint, Drawing& drawing);

}  // namespace weft::client

// SPDX-License-Identifier: Apache-2.0
// The rules that a list of triangles obeys by itself, whatever it covers.
#pragma once

#include "checker/mesh.h"
#include "checker/report.h"

namespace weft::check {

// kStructure: lists of matching lengths, indices in range, three distinct corners, coordinates in
// the checker's range, no vertex without a triangle. Returns false if there is a violation.
bool judge_structure(const Mesh& mesh, Findings& findings);

// kOrientation, exact. REQUIRES: judge_structure was true.
bool judge_orientation(const Mesh& mesh, Findings& findings);

}  // namespace weft::check

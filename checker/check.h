// SPDX-License-Identifier: Apache-2.0
// The independent judge of meshes: does this mesh cover this domain, and does it satisfy its
// bounds? It shares no code with the engine. Topology, orientation, coverage without overlap and
// the Delaunay property are decided exactly; if vertices are rounded, a stated tolerance of a
// few units in the last place applies (tolerance.h, coverage.h, quality.h).
//
//   const Report report = check(domain, mesh, {.size = "0.01 + x^2", .min_angle_deg = 20});
//   if (!report.ok()) std::cerr << to_text(report);
//
// Hostile input (NaN, indices out of range, empty lists) is a violation, nothing worse. Rules
// build on each other: if a rule is violated, rules that need it are not judged, and
// Report::not_judged lists them. Below a second and 100 MB per million triangles. Thread-safe.
#pragma once

#include "checker/domain.h"
#include "checker/mesh.h"
#include "checker/mesh/quality.h"
#include "checker/report.h"

namespace weft::check {

Report check(const Domain& domain, const Mesh& mesh, const Requirements& requirements = {});

}  // namespace weft::check

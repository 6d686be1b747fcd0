// SPDX-License-Identifier: Apache-2.0
// Judges a simplified domain against the original one.
//
// `finest` at a point is the share that was asked for of the length of edges that the size allows
// there: of an equilateral triangle of the largest area, without a gradation, which only makes it
// less; infinite if there is none. Where two points have two, the larger counts.
#pragma once

#include "checker/domain.h"
#include "checker/domain/fill.h"
#include "checker/geometry/arrangement.h"
#include "checker/mesh.h"
#include "checker/mesh/quality.h"
#include "checker/report.h"

namespace weft::check {

// Equilateral triangles with edges of the largest `finest` on the border.
inline constexpr double kMaxCutOff = 100;

// A domain with its faces.
struct FacedDomain {
  const Domain& domain;
  const Arrangement& arrangement;
  const std::vector<FaceRole>& roles;  // per face
};

// Adds violations of kSimplified:
//   - a point of a segment is farther than `finest` from all segments of the original with its
//     marker; points along the segment are an eighth of that apart;
//   - a point that is farther than `finest` from all segments of the original is meshed in one and
//     not in the other, or has another region. The points are beside the original's segments, on
//     both sides, and in the triangles of the mesh: 20,000 at most. A water behind a channel that
//     was closed need not be meshed: what of its face, in the lines of both domains together, is
//     more than `finest` / 2 from its border must be smaller than kMaxCutOff triangles, and the
//     original's face must have had more than this;
//   - a point of the original inside the domain is no vertex of the mesh, though no segment names
//     it; or two or more segments end there, of several markers, or not just two do.
// Fills in Facts::area_change. REQUIRES: the mesh matches `simple`.
void judge_simplification(const FacedDomain& original, const FacedDomain& simple, const Mesh& mesh,
                          const Requirements& requirements, Facts& facts, Findings& findings);

}  // namespace weft::check

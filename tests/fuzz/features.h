// SPDX-License-Identifier: Apache-2.0
// What a case asks beyond what can be decided, or met, in double precision. Looked at when a law is
// broken, so nothing here need be fast.
#pragma once

#include "tests/fuzz/mesh_case.h"

namespace weft::fuzz {

// Whether features (points, segments, crossings) are about as far from each other as the merging
// tolerance T, between T / 16 and 16 T. Then merging has a choice, and leads features to others,
// one after the other; a judge who sees the mesh alone cannot always tell which segment became
// which edges, above all where parts of them are carved away. The checker holds such a case to
// what it can tell: its verdicts on chains, points, coverage and the like are open there.
bool is_contested(const MeshCase& mesh_case);

// Whether two segments meet at such a small angle, with such a fine feature beside the corner, that
// no mesh in double precision meets the bounds: where triangles must be as small as the feature,
// the segments are nearer to each other than refinement's floor (kEdgeFraction in
// engine/domain/tolerance.h), times 4. The corner may be any vertex that both pass: merging leads
// two segments at a small angle through one vertex where a third crosses both.
bool is_too_fine(const MeshCase& mesh_case);

// Whether a vertex of a field's mesh lies on an edge that it is no end of, or nearly so: in a
// needle, at the end of an edge that overlaps another one, beside its copy. Then rounding of a
// point, or of its distance to two edges, decides which value the point gets where several meet,
// and the engine and the checker round otherwise: one weighs three corners, the other two ends of
// an edge.
bool is_ambiguous(const FieldMesh& mesh);

// Whether the size is a distance somewhere, so that it goes to 0 at what the distance is to: there
// no triangle is small enough.
bool asks_for_nothing(const MeshCase& mesh_case);

}  // namespace weft::fuzz

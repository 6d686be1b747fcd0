// SPDX-License-Identifier: Apache-2.0
// The caller's bounds on triangles, and the measures of triangles.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "checker/domain/fill.h"
#include "checker/mesh.h"
#include "checker/mesh/exemption.h"
#include "checker/mesh/layers.h"
#include "checker/report.h"
#include "checker/size/size.h"

namespace weft::check {

// By how much rounding may miss a bound.
inline constexpr double kAngleTolerance = 1e-7;  // degrees
inline constexpr double kAreaTolerance = 1e-9;   // of the bound

struct Requirements {
  // Upper bound on every triangle's area, squared units. Default: none.
  std::optional<double> max_area;
  // Upper bound on a triangle's area at its centroid; with `max_area`, both hold. Default: none.
  // With a gradation, no triangle may be larger than any sample allows (gradation.h): the sizes at
  // all centroids and vertices of the mesh. The facts take a size that a triangle keeps to as it is
  // without the limit, because to know that one is enough, and the least of all is slow to find.
  SizeSpec size;
  // Lower bound on every angle, degrees. Default: none.
  std::optional<double> min_angle_deg;
  // The domain that the mesh has may be simplified to this share of the length of edges that the
  // size allows (simplification.h): then the mesh is judged against its own segments, and these
  // against the domain. 0: it may not.
  double simplify = 0;
  // Edges on arcs turn by at most 360 degrees divided by this, and by 60.
  double points_per_circle = 0;
  // Segments with these markers have no vertices but those of the domain; if it is empty, all have
  // none. Default: any may have.
  std::optional<std::vector<std::int32_t>> keep;
  // Markers of sides that repeat each other.
  std::vector<std::array<std::int32_t, 2>> periodic;
  // Layers along walls; the bounds on triangles are not for theirs.
  std::vector<LayerRows> layers;
  // Whether small input angles exempt (exemption.h).
  bool allow_small_input_angles = true;
  // Maximum triangles that may miss the angle or the area bound without exemption: those that the
  // engine declared as unrefined because of a budget or the floor on edge lengths.
  std::uint64_t allowed_unrefined = 0;
  // Violations written out per rule; the rest is counted.
  std::uint64_t listed_violations = 10;
};

// Data that the bounds need besides the triangles. It is absent if other violations prevent it:
// then an angle that might be exempt is not judged, and no region bounds an area.
struct QualityContext {
  const SmallInputAngles* small_input_angles = nullptr;
  std::span<const std::uint32_t> faces;         // per triangle
  std::span<const FaceRole> roles;              // per face
  const std::vector<bool>* is_layer = nullptr;  // per triangle: only its area counts
};

// Adds violations of kSize, kAngle and kArea, and fills in the measures of `facts`.
//   - An angle may be below the bound by kAngleTolerance.
//   - An area may exceed its bound by kAreaTolerance of it. The bound at the centroid is the
//     largest of the nine values at distances 0 and 16 * 2^-53 * (largest coordinate of the
//     triangle) along x and y, because centroids and distances are rounded, and the size may be
//     discontinuous, or end, there.
// REQUIRES: structure and orientation hold.
void judge_quality(const Domain& domain, const Mesh& mesh, const Requirements& requirements,
                   const QualityContext& context, Facts& facts, Findings& findings);

// Adds violations of kLengths: of listed edges whose marker has a size of its own. A length may
// exceed it by 2e-9 of it and 2^-49 of the largest coordinate of the edge. Nothing is judged if
// triangles may miss their bounds. REQUIRES: structure holds.
void judge_lengths(const Mesh& mesh, const Requirements& requirements, Findings& findings);

}  // namespace weft::check

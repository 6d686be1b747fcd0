// SPDX-License-Identifier: Apache-2.0
// The engine's face: a PSLG and a size field go in, a guaranteed-quality Delaunay mesh comes out
// in chunks. A. N. Chernikov and N. P. Chrisochoides, "Parallel 2D Graded Guaranteed Quality
// Delaunay Mesh Refinement", 2006.
//
//   ExecutionContext context;
//   MeshRequest request{.pslg = square, .size = {.expression = "0.01 + x^2"}};
//   Result<Summary> summary = generate_mesh(request, sink, context);
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "engine/chunk.h"
#include "engine/context.h"
#include "engine/domain/pslg.h"
#include "engine/error.h"
#include "engine/size/raster.h"
#include "engine/summary.h"

namespace weft {

// Changes whenever the same request may give other bytes.
inline constexpr std::string_view kEngineVersion = "4";

// The grading function: an upper bound on a triangle's area at its centroid, squared units.
// At most one of the three is set; none means no bound on the area.
struct SizeSpec {
  std::optional<double> constant = std::nullopt;         // > 0
  std::optional<std::string> expression = std::nullopt;  // of x and y, see size/expression.h
  // See size/raster.h. REQUIRES: its spacing is positive and finite, its origin finite, it has
  // columns * rows values, one at least.
  std::optional<Raster> raster = std::nullopt;
};

inline constexpr double kMaxMinAngleDeg = 36;
inline constexpr std::uint32_t kMaxSweeps = 16;

// Where the Steiner points of triangles that are too large go (refine/steiner_point.h).
enum class Placement : std::uint8_t {
  // To a hexagonal lattice that follows the size: a third fewer triangles, nearly all of them
  // equilateral, along three directions. Above 31.5 degrees as kCircumcentre.
  kLattice,
  // To circumcentres: no direction in the mesh, and half as many triangles more.
  kCircumcentre,
};

struct MeshRequest {
  Pslg pslg = {};
  SizeSpec size = {};
  // Lower bound on every angle. REQUIRES: 0 <= min_angle_deg <= kMaxMinAngleDeg.
  double min_angle_deg = 20;
  // No edge shorter than this is made, in units. 0: only the floor of double precision.
  double min_edge = 0;
  Placement placement = Placement::kLattice;
  // Sweeps of smoothing (refine/smoother.h), at most kMaxSweeps. Unset: two where the size makes
  // nearly all triangles, on a lattice; otherwise none.
  std::optional<std::uint32_t> sweeps = std::nullopt;
  // Whether a mesh with triangles that miss a bound without excuse (Unrefined::without_excuse) is a
  // result. If not, it ends with kBoundsNotMet, after its chunks.
  bool allow_unrefined = false;
  // Triangles of the final mesh that a leaf of the quadtree holds at most. About 16,000 are
  // fastest; another number gives another mesh. Not on the wire: for tests and measurements.
  double leaf_triangles = 16'000;
};

// Computes in the context's arena; calls the sink on the calling thread. Errors carry the field
// path of the request as the wire spells it; what the sink took before an error is no mesh. Never
// throws.
Result<Summary> generate_mesh(const MeshRequest& request, ChunkSink& sink,
                              ExecutionContext& context);

}  // namespace weft

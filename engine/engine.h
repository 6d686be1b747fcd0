// SPDX-License-Identifier: Apache-2.0
// The engine's face: a PSLG and a size field go in, a guaranteed-quality Delaunay mesh comes out
// in chunks. A. N. Chernikov and N. P. Chrisochoides, "Parallel 2D Graded Guaranteed Quality
// Delaunay Mesh Refinement", 2006.
//
//   ExecutionContext context;
//   MeshRequest request{.pslg = square, .size = "0.01 + x^2"};
//   Result<Summary> summary = generate_mesh(request, sink, context);
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "engine/base/context.h"
#include "engine/base/error.h"
#include "engine/domain/pslg.h"
#include "engine/output/chunk.h"
#include "engine/output/summary.h"
#include "engine/size/size_spec.h"

namespace weft {

// Changes whenever the same request may give other bytes.
inline constexpr std::string_view kEngineVersion = "7";

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
  // Sweeps of smoothing (smoother.h), at most kMaxSweeps. Unset: two if the size makes
  // nearly all triangles, on a lattice that has few faults or in a mesh below 100,000 triangles;
  // otherwise none.
  std::optional<std::uint32_t> sweeps = std::nullopt;
  // Whether a mesh with triangles that miss a bound without exemption
  // (Unrefined::without_exemption) is a result. If not, it ends with kBoundsNotMet, after its
  // chunks.
  bool allow_unrefined = false;
  // Triangles of the final mesh that a leaf of the quadtree holds at most. Another number gives
  // another mesh. Not on the wire: for tests and measurements. Unset: see leaf_triangles_for.
  std::optional<double> leaf_triangles = std::nullopt;
};

// Judges the ranges of the options: all that generate_mesh refuses before it looks at the size and
// the domain. Does not read `pslg` and `size`.
std::optional<Error> check_options(const MeshRequest& request);

// Judges what generate_mesh refuses of a PSLG before it triangulates: counts, coordinates, indices,
// segments without length, region bounds, points on one line. Linear time.
std::optional<Error> check_pslg(const Pslg& pslg);

// Computes in the context's arena; calls the sink on the calling thread. Errors carry the field
// path of the request as the wire spells it; what the sink took before an error is no mesh. Never
// throws.
Result<Summary> generate_mesh(const MeshRequest& request, ChunkSink& sink,
                              ExecutionContext& context);

// Bounds the memory that ended runs leave for later ones, in all of the process: 1 GiB unless this
// sets another bound. Runs that have ended already keep theirs. Each heap of malloc keeps at most a
// 128th of the bound, and at most 16 MiB, at its end; vectors up to that size, and up to 4 MiB,
// come from it: us-east-coast without a size takes 8 % less time than with malloc's defaults,
// because the system clears 20 pages for it instead of 320. Thread-safe.
void keep_memory_at_most(std::uint64_t bytes);

}  // namespace weft

// SPDX-License-Identifier: Apache-2.0
// weft, the library: a planar straight-line graph and a size go in, a guaranteed-quality Delaunay
// mesh comes out. A. N. Chernikov and N. P. Chrisochoides, "Parallel 2D Graded Guaranteed Quality
// Delaunay Mesh Refinement", 2006.
//
//   weft::MeshRequest request{.pslg = square, .size = "0.01 + x^2", .min_angle_deg = 25};
//   weft::Result<weft::Mesh> made = weft::mesh(request);
//
// Law: the same request gives the same mesh, byte for byte, on any number of threads and on every
// x86-64-v2 and arm64 machine. No function throws.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "weft/error.h"
#include "weft/mesh.h"
#include "weft/pslg.h"
#include "weft/run.h"
#include "weft/size.h"

namespace weft {

// Changes whenever the same request may give other bytes.
extern const std::string_view kEngineVersion;

inline constexpr double kMaxMinAngleDeg = 36;
inline constexpr std::uint32_t kMaxSweeps = 16;
inline constexpr std::size_t kMaxKeptMarkers = 4096;
inline constexpr std::size_t kMaxPeriodicPairs = 16;
inline constexpr std::size_t kMaxLayers = 16;
inline constexpr std::uint32_t kMaxLayerRows = 200;
inline constexpr double kMaxLayerRatio = 10;
inline constexpr std::size_t kMaxSamplePoints = std::size_t{1} << 18;

// Two sides of the domain that repeat each other, by the markers of their segments: a translation
// or a rotation takes one to the other, and the inside of the domain at one to the outside at the
// other.
struct PeriodicPair {
  std::int32_t from = 0;
  std::int32_t to = 0;
};

// Rows of thin triangles along the segments with a marker, which are straight and on the boundary
// of the domain. They are no thicker than there is room for.
struct Layers {
  std::int32_t marker = 0;
  double first = 0;        // height of the row at the wall, > 0
  double ratio = 1;        // of the heights of each row and the one before, 1 to kMaxLayerRatio
  std::uint32_t rows = 1;  // 1 to kMaxLayerRows
  // Of their triangles; unset: one more than the highest of the domain, at least 1.
  std::optional<std::int32_t> region = std::nullopt;
};

// Where the Steiner points of triangles that are too large go.
enum class Placement : std::uint8_t {
  // To a hexagonal lattice that follows the size: a third fewer triangles, nearly all of them
  // equilateral, along three directions. Above 31.5 degrees as kCircumcentre.
  kLattice,
  // To circumcentres: 50 % more triangles, in no preferred direction.
  kCircumcentre,
};

struct MeshRequest {
  Pslg pslg = {};
  SizeSpec size = {};
  // Lower bound on every angle. REQUIRES: 0 <= min_angle_deg <= kMaxMinAngleDeg.
  double min_angle_deg = 20;
  // No edge shorter than this is made, in units. 0: only the floor of double precision.
  double min_edge = 0;
  // Refinement puts no vertex on segments with these markers, at most kMaxKeptMarkers; if it is
  // empty, on no segment. Of segments that overlap, the first one's marker counts. Triangles there
  // that miss a bound for it are exempt (Unrefined::kept). REQUIRES: simplify is 0, no such segment
  // is an arc, no such marker has a length of edges in size.at.
  std::optional<std::vector<std::int32_t>> keep = std::nullopt;
  // Pairs of sides with the same vertices: where one has a vertex, so has the other. REQUIRES: at
  // most kMaxPeriodicPairs, no marker twice; each side is one line of straight segments; simplify
  // is 0, keep names none of them, and the budget does not end the mesh.
  std::vector<PeriodicPair> periodic = {};
  // At most kMaxLayers, of one marker each; walls that meet have the same rows. Bounds hold outside
  // of layers; they are cut to 0.4 of the way to what is opposite, and end on the next side where
  // that makes 45 to 135 degrees with the wall, else in a point. REQUIRES: the domain has no arcs;
  // simplify is 0, periodic is empty, keep names none of the markers.
  std::vector<Layers> layers = {};
  Placement placement = Placement::kLattice;
  // Above 0: refinement in stages, then so many sweeps of smoothing, up to kMaxSweeps. Unset: 2 if
  // the size makes nearly all triangles, on lattices with few faults or below 100,000 triangles.
  std::optional<std::uint32_t> sweeps = std::nullopt;
  // The domain is made no finer than this share of the length of edges that the size, regions and
  // sizes at markers ask for at each place, that of an equilateral triangle of the largest area.
  // The size is that of the domain as it was. 0: as it is. REQUIRES: finite, 0 or more.
  double simplify = 0;
  // Whether a mesh with triangles that miss a bound without exemption
  // (Unrefined::without_exemption) is a result. If not, it ends with kBoundsNotMet, after its
  // chunks.
  bool allow_unrefined = false;
  // Not empty: no mesh is made, but for Summary::sampled_bounds, the size at these points. At most
  // kMaxSamplePoints. REQUIRES: coordinates are at most kMaxMagnitude.
  std::vector<Point> sample_points = {};
  // Most triangles in a leaf of the quadtree: another mesh. For tests. Unset: by the mesh's size.
  std::optional<double> leaf_triangles = std::nullopt;
};

// All that can be refused before work: what the four functions below refuse.
std::optional<Error> validate(const MeshRequest& request);

// Judges the ranges of the options. Does not read `pslg` and `size`.
std::optional<Error> check_options(const MeshRequest& request);

// Judges what needs neither the domain nor the values of arrays: a constant, an expression, names
// of fields, the gradation, cells_across and the sizes at markers.
std::optional<Error> check_size(const SizeSpec& size);

// kBadSizeValue with the field "size.raster.values[i]" for the first value that is not positive and
// finite. REQUIRES: columns > 0.
std::optional<Error> check_raster_values(std::span<const double> values, std::uint32_t columns);

// Judges what a run refuses of a PSLG before it triangulates: counts, coordinates, indices,
// segments without length, region bounds, points on one line. Linear time.
std::optional<Error> check_pslg(const Pslg& pslg);

struct Estimate {
  std::uint64_t triangles = 0;    // on the high side, up to 2.5 times as many as are made
  std::uint64_t bytes = 0;        // of engine memory at the peak
  std::uint64_t least_bytes = 0;  // without which the run ends as it begins: those of its size
};

// What a run is expected to make and to take, at most what the budget allows: a guess, in linear
// time, without a triangulation and what fields of an expression ask for. REQUIRES nothing.
Estimate estimate(const MeshRequest& request, const Budget& budget = {});

// Makes the mesh and sends it to the sink, chunk by chunk, most of a large mesh while it is
// refined. Computes where the run says; calls the sink on the calling thread. What the sink took
// before an error is no mesh.
Result<Summary> stream(const MeshRequest& request, ChunkSink& sink, Run& run);

// Makes the mesh all at once. Without a run: unbounded, on the calling thread.
Result<Mesh> mesh(const MeshRequest& request, Run& run);
Result<Mesh> mesh(const MeshRequest& request);

// Bounds the memory that ended runs leave for later ones, in all of the process: 1 GiB unless this
// sets another bound; and in proportion, at most 16 MiB, what each heap of malloc keeps at its end.
// Runs that have ended already keep theirs. Thread-safe.
void keep_memory_at_most(std::uint64_t bytes);

}  // namespace weft

// SPDX-License-Identifier: Apache-2.0
// What a run is expected to make and to take: a guess within a millisecond for a domain of usual
// size, from a coarse picture of the domain, its regions, and the size in each cell.
//
// Law: the bytes are never below what the engine takes for the benchmarks' meshes if their reader
// stalls, and at most twice that and 2 MB (tests/engine/estimate_law_test.cpp).
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <variant>

#include "engine/domain/arcs/flat_arcs.h"
#include "engine/domain/domain_picture.h"
#include "engine/parallel/mesh_plan.h"
#include "engine/parallel/task_graph.h"
#include "engine/refine/edge_limits.h"
#include "engine/refine/quality_bounds.h"
#include "engine/size/lattice/lattice.h"
#include "engine/size/size_spec.h"
#include "weft/weft.h"

namespace weft {
namespace {

// As measured: 48 bytes a triangle of a mesh that is held as a whole, and 300 bytes a point for the
// constrained triangulation.
constexpr double kBytesPerTriangle = 48;
constexpr double kBytesPerPoint = 300;
// Of the lattices of a size that varies (size/lattice/lattice_map.h): one for some 80 triangles
// where they change within a few rows, and no more than about this in all.
constexpr double kBytesOfLattices = 5;  // a triangle
constexpr double kMaxBytesOfLattices = 8e6;
// Any run takes this for tables and buffers.
constexpr double kBytesPerRun = 1e6;
// Over triangles_per_bound, which is what comes out if the size is the same everywhere: where it
// changes within a few triangles there are up to half more.
constexpr double kMoreOnLattice = 1.48;
constexpr double kMoreAtCircumcentres = 1.16;
constexpr double kIfItVaries = 1.1;  // on the lattice, unless the size is the same everywhere
// Angles alone ask for about so many.
constexpr double kTrianglesPerPoint = 4;

// Of a mesh that leaves while it is refined (parallel/mesh_plan.h): a strip of leaves is held, and
// what each leaf has all the time. Measured with 10 M to 1,000 M triangles: 370 for a size that
// grows with the distance from something, up to half more for one that is the same everywhere.
constexpr double kBytesOfStrip = 420;  // times the root of triangles of the mesh and of a leaf
constexpr double kBytesPerLeaf = 2700;
// Full ones. With fewer, nearly all leaves may have begun before much is sent, if a thread stands
// still for a while.
constexpr double kMinLeaves = 128;
// The strip of a mesh of up to about so many leaves is this much larger where the size varies: they
// are done in the order of the shortest chains (parallel/leaf_order.h), not along the sweep.
constexpr double kFewLeaves = 256;
constexpr double kMoreOfFewLeaves = 1.4;
// Of layers (layers/layer_filler.h): edges on walls over those that the size asks for, and what is
// kept of the rest of the mesh, per triangle of it.
constexpr double kEdgesOnWall = 1.6;
constexpr double kBytesBesideLayers = 16;
// Of fragments that are built and wait for their reader, per triangle. If the reader stalls, so
// many full leaves wait: fragments_ahead, each of which is about .6 of the largest.
constexpr double kBytesOfWaiting = 22;
constexpr int kThreads = 2;
double full_leaves_waiting() {
  return 0.6 * fragments_ahead(kThreads);
}

double inverse(double bound) {
  return bound > 0 ? 1 / bound : 0;  // a run refuses what is no bound
}

// The size whose triangles have the mean number of those at up to kSamples nodes.
double mean_size(const Raster& raster, Measure measure) {
  constexpr std::size_t kSamples = 1024;
  const std::size_t step = 1 + raster.values.size() / kSamples;
  const double power = measure == Measure::kEdge ? -2 : -1;
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < raster.values.size(); i += step, ++count)
    sum += raster.values[i] > 0 ? std::pow(raster.values[i], power) : 0;
  return std::pow(sum / count, 1 / power);
}

// A size that asks for about as many triangles; no bound if `spec` is none, or names fields: what
// these ask for is known once they are made.
Size size_to_estimate_by(const SizeSpec& spec) {
  const auto* const raster = std::get_if<Raster>(&spec.value);
  auto made = raster != nullptr ? make_size(mean_size(*raster, spec.measure), spec.measure)
                                : make_size(spec.value, spec.measure);
  if (!made) made = make_size(SizeSpec::Value(), Measure::kArea);
  return std::move(*made);
}

// The integral of 1 / bound over the domain, for the size and the bounds of its regions, and
// whether it is the same everywhere.
struct Integral {
  double sum = 0;
  bool is_even = true;
};

Integral integral(const DomainPicture& picture, const SizeFunction& size) {
  constexpr int kCells = DomainPicture::kCells;
  double sum = 0;
  double least = std::numeric_limits<double>::infinity();
  double most = 0;
  for (int row = 0; row < kCells; ++row) {
    alignas(64) double xs[kCells];
    alignas(64) double ys[kCells];
    alignas(64) double bounds[kCells];
    for (int column = 0; column < kCells; ++column) {
      const Point middle = picture.middle(column, row);
      xs[column] = middle.x;
      ys[column] = middle.y;
    }
    size.evaluate(kCells, xs, ys, bounds);
    for (int column = 0; column < kCells; ++column) {
      const double inside = picture.part_inside(column, row);
      if (inside == 0) continue;
      const double per_area =
          std::max(inverse(bounds[column]), inverse(picture.max_area(column, row)));
      sum += inside * per_area;
      least = std::min(least, per_area);
      most = std::max(most, per_area);
    }
  }
  return {sum * picture.area_of_cell(), !(most > least)};
}

// The run has a budget for its chords, the estimate has none: many arcs get fewer.
DomainPicture picture_of_arcs(const Pslg& pslg) {
  constexpr double kMaxChords = 1 << 20;
  const auto chords = static_cast<double>(count_chords(pslg));
  return DomainPicture::of(flatten_arcs(pslg, kFlatTurn * std::max(1.0, chords / kMaxChords)));
}

// What the size and the regions ask for.
struct BySize {
  double triangles = 0;
  bool varies = false;  // on lattices that follow it
};

BySize by_size_of(const MeshRequest& request) {
  const DomainPicture picture =
      request.pslg.arcs.empty() ? DomainPicture::of(request.pslg) : picture_of_arcs(request.pslg);
  const Size size = size_to_estimate_by(request.size);
  const Integral over_bound = integral(picture, size.function());
  LatticeShape lattice;
  if (request.placement == Placement::kLattice)
    lattice = LatticeShape::for_angle(request.min_angle_deg);
  const double triangles = triangles_per_bound(lattice) * over_bound.sum;
  if (!lattice.exists()) return {kMoreAtCircumcentres * triangles, false};
  const bool is_raster = std::holds_alternative<Raster>(request.size.value);
  return {kMoreOnLattice * triangles * (over_bound.is_even ? 1 : kIfItVaries),
          is_raster || !(over_bound.is_even || size.function().constant())};
}

EdgeLimits limits_of(const SizeSpec& size) {
  std::vector<SizeAt> at;
  for (const SizeAt& length : size.at)
    if (length.max_edge > 0) at.push_back(length);
  return EdgeLimits(std::move(at));
}

// Whether the size is made of the domain's triangulation, in which arcs are chords: not if it is
// the same everywhere.
bool sees_chords(const MeshRequest& request) {
  const SizeSpec& size = request.size;
  return !request.pslg.arcs.empty() &&
         (std::holds_alternative<std::string>(size.value) ||
          std::holds_alternative<Raster>(size.value) || !size.fields.empty() ||
          size.gradation > 0 || size.cells_across > 0);
}

// What the lengths at markers ask for.
double triangles_by_pieces(const MeshRequest& request) {
  const EdgeLimits limits = limits_of(request.size);
  if (limits.empty()) return 0;
  const auto& points = request.pslg.points;
  double pieces = 0;
  for (const Segment& s : request.pslg.segments) {
    if (s.a >= points.size() || s.b >= points.size()) continue;
    const double of_segment = limits.pieces(s.marker, points[s.a], points[s.b]);
    if (of_segment > 1) pieces += of_segment;
  }
  const double gradation = request.size.gradation;
  return EdgeLimits::kTrianglesPerPiece * pieces / (gradation > 0 ? std::min(gradation, 1.0) : 1.0);
}

// The edges that the size makes of a segment, as at kSamples places of it.
double edges_by_size(Point a, Point b, const SizeFunction& size) {
  constexpr int kSamples = 4;
  double sum = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double t = (i + 0.5) / kSamples;
    const double area = size({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)});
    if (area > 0) sum += 1 / SizeFunction::edge_of_area(area);
  }
  return std::hypot(b.x - a.x, b.y - a.y) * sum / kSamples;
}

// Those of layers along walls: a column at each edge of the mesh there.
double triangles_of_layers(const MeshRequest& request) {
  if (request.layers.empty()) return 0;
  const Size size = size_to_estimate_by(request.size);
  const EdgeLimits limits = limits_of(request.size);
  const auto& points = request.pslg.points;
  double triangles = 0;
  for (const Layers& layers : request.layers)
    for (const Segment& s : request.pslg.segments) {
      if (s.marker != layers.marker || s.a >= points.size() || s.b >= points.size()) continue;
      const Point a = points[s.a], b = points[s.b];
      const double edges = std::max(limits.pieces(s.marker, a, b),
                                    1 + kEdgesOnWall * edges_by_size(a, b, size.function()));
      triangles += 2.0 * layers.rows * edges;
    }
  return triangles;
}

// Bytes of a mesh that is held as a whole, or, if it may stream, of the strip that is held; and of
// its fragments that wait for their reader.
double bytes_of_mesh(double triangles, double of_leaf, bool may_stream, bool varies) {
  const double whole = kBytesPerTriangle * triangles;
  const double waiting = kBytesOfWaiting * std::min(triangles, full_leaves_waiting() * of_leaf);
  const double leaves = triangles / of_leaf;
  if (!may_stream || leaves < kMinLeaves) return whole + waiting;
  const double strip = kBytesOfStrip * std::sqrt(triangles * of_leaf) *
                           (varies && leaves < kFewLeaves ? kMoreOfFewLeaves : 1) +
                       kBytesPerLeaf * leaves;
  return std::min(whole, strip) + waiting;
}

double bytes_of_lattices(const BySize& by_size) {
  return by_size.varies ? std::min(kBytesOfLattices * by_size.triangles, kMaxBytesOfLattices) : 0;
}

// Numbers that are not finite become `most`.
std::uint64_t at_most(std::uint64_t most, double value) {
  return value < static_cast<double>(most) ? static_cast<std::uint64_t>(value) : most;
}

}  // namespace

Estimate estimate(const MeshRequest& request, const Budget& budget) {
  const auto points = static_cast<double>(request.pslg.points.size());
  const std::uint64_t most = std::min(budget.max_triangles, budget.triangle_limit);
  const bool samples = !request.sample_points.empty();  // and makes no mesh
  const BySize by_size = samples ? BySize() : by_size_of(request);
  const double of_layers = samples ? 0 : triangles_of_layers(request);
  const double of_pieces = samples ? 0 : triangles_by_pieces(request);
  const double triangles = std::min(by_size.triangles + of_pieces + kTrianglesPerPoint * points,
                                    static_cast<double>(most));
  const bool may_stream = budget.max_triangles == Budget{}.max_triangles &&
                          request.min_angle_deg <= kMaxStreamingAngleDeg && !request.keep;
  const std::uint64_t least = bytes_to_make(request.size, request.pslg);
  const double chords = sees_chords(request) ? static_cast<double>(count_chords(request.pslg)) : 0;
  const double bytes =
      kBytesPerRun + kBytesPerPoint * (points + chords) + static_cast<double>(least) +
      bytes_of_lattices(by_size) +
      (request.layers.empty() ? 0 : kBytesBesideLayers * triangles + kBytesPerPoint * points) +
      bytes_of_mesh(triangles, request.leaf_triangles.value_or(leaf_triangles_for(triangles)),
                    may_stream, by_size.varies);
  return {at_most(most, triangles + of_layers), at_most(budget.max_bytes, bytes), least};
}

}  // namespace weft

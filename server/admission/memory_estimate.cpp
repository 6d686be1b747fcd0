// SPDX-License-Identifier: Apache-2.0
#include "server/admission/memory_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "engine/base/geometry.h"
#include "engine/engine.h"
#include "server/admission/domain_picture.h"
#include "server/wire/size_field.h"

namespace weft::server {
namespace {

// As measured: 48 bytes a triangle of a mesh that is held as a whole, and 300 bytes a point for the
// constrained triangulation.
constexpr double kBytesPerTriangle = 48;
constexpr double kBytesPerPoint = 300;
// Any run takes this for tables and buffers.
constexpr double kBytesPerRun = 1e6;
// Triangles times the bound over the area, at circumcentres: 1.55 if the size is the same
// everywhere. Where it changes within a few triangles there are up to half more. Angles alone ask
// for about four triangles a point.
constexpr double kTrianglesPerArea = 1.8;
constexpr double kOnLattice = 1.52;  // over what part of its bound a triangle there fills
constexpr double kIfItVaries = 1.1;  // times that, unless the size is the same everywhere
constexpr double kTrianglesPerPoint = 4;
// Around an edge on a segment whose length is limited: 3.9 as measured, if the bound on angles
// alone makes triangles grow from there; with a gradation as many as it is slower than that.
constexpr double kTrianglesPerPiece = 4;

// Of a mesh that leaves while it is refined (engine/schedule/mesh_run.h): a strip of leaves is
// held, and what each leaf has all the time. Measured with 10 M to 1,000 M triangles: 370 for a
// size that grows with the distance from something, up to half more for one that is the same
// everywhere.
constexpr double kMostStreamingAngleDeg = 30;
// Full ones. With fewer, nearly all leaves may have begun before much is sent, if a thread stands
// still for a while.
constexpr double kFewestLeaves = 128;
constexpr double kBytesOfStrip = 420;  // times the root of triangles of the mesh and of a leaf
constexpr double kBytesPerLeaf = 2700;
// Of parts that are built and wait for their reader, per triangle. If the reader stalls, 40 leaves
// wait (parts_ahead in engine/base/trace.h), of which each is about .6 of the largest.
constexpr double kBytesOfWaiting = 22;
constexpr double kFullLeavesWaiting = 24;

double triangles_of_leaf(double triangles) {
  const double fewer = 3.2e10 / triangles;
  return std::clamp(fewer, std::clamp(0.4 * std::sqrt(triangles), 6'000.0, 16'000.0), 16'000.0);
}

double inverse(double bound) {
  return bound > 0 ? 1 / bound : 0;  // the engine refuses what is no bound
}

double min_angle_of(const v1::GenerateMeshRequest& request) {
  return request.quality().has_min_angle_deg() ? request.quality().min_angle_deg()
                                               : MeshRequest{}.min_angle_deg;
}

// How much of its bound a triangle of the lattice fills (engine/size/lattice/lattice.h); 0 if there
// is no lattice.
double fill_of_lattice(const v1::GenerateMeshRequest& request) {
  const double angle = min_angle_of(request);
  if (request.quality().placement() == v1::PLACEMENT_CIRCUMCENTRE || angle > 31.5) return 0;
  return angle <= 29.5 ? 0.99 : 0.968 - 0.11 * std::max(0.0, angle - 30);
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

// What the size and the regions ask for.
double triangles_by_size(const v1::GenerateMeshRequest& request) {
  const DomainPicture picture = DomainPicture::of(request.domain());
  const Integral over_bound = integral(picture, size_to_estimate_by(request.size()).function());
  const double fill = fill_of_lattice(request);
  if (fill == 0) return over_bound.sum * kTrianglesPerArea;
  return over_bound.sum * kOnLattice / fill * (over_bound.is_even ? 1 : kIfItVaries);
}

// What the lengths at markers ask for.
double triangles_by_pieces(const v1::GenerateMeshRequest& request) {
  const v1::Domain& domain = request.domain();
  const auto count = static_cast<std::uint32_t>(domain.points_size() / 2);
  const int segments = std::min(domain.segments_size() / 2, domain.segment_markers_size());
  std::map<std::int32_t, double> edges;  // by marker
  for (const v1::SizeAt& at : request.size().at())
    if (at.max_edge() > 0) edges[at.marker()] = at.max_edge();
  if (edges.empty()) return 0;
  double pieces = 0;
  for (int i = 0; i < segments; ++i) {
    const auto edge = edges.find(domain.segment_markers(i));
    const std::uint32_t a = domain.segments(2 * i);
    const std::uint32_t b = domain.segments(2 * i + 1);
    if (edge == edges.end() || a >= count || b >= count) continue;
    const auto& points = domain.points();
    const auto from = static_cast<int>(2 * a);
    const auto to = static_cast<int>(2 * b);
    pieces +=
        std::hypot(points[to] - points[from], points[to + 1] - points[from + 1]) / edge->second;
  }
  const double gradation = request.size().gradation();
  return kTrianglesPerPiece * pieces / (gradation > 0 ? std::min(gradation, 1.0) : 1.0);
}

// Bytes of a mesh that is held as a whole, or, if it may stream, of the strip that is held; and of
// its parts that wait for their reader.
double bytes_of_mesh(double triangles, bool may_stream) {
  const double whole = kBytesPerTriangle * triangles;
  const double of_leaf = triangles_of_leaf(triangles);
  const double waiting = kBytesOfWaiting * std::min(triangles, kFullLeavesWaiting * of_leaf);
  const double leaves = triangles / of_leaf;
  if (!may_stream || leaves < kFewestLeaves) return whole + waiting;
  const double strip = kBytesOfStrip * std::sqrt(triangles * of_leaf) + kBytesPerLeaf * leaves;
  return std::min(whole, strip) + waiting;
}

}  // namespace

std::uint64_t bytes_besides(const Limits& limits) {
  constexpr std::uint64_t kBuffers = std::uint64_t{8} << 20;
  return kBuffers + limits.stream_buffer;
}

std::uint64_t expected_bytes(const v1::GenerateMeshRequest& request, const Limits& limits) {
  const std::uint64_t most =
      request.budget().max_bytes() != 0 ? request.budget().max_bytes() : limits.max_bytes;
  const bool capped = request.budget().max_triangles() != 0;
  const std::uint64_t most_triangles =
      capped ? request.budget().max_triangles() : limits.max_triangles;
  const double points = request.domain().points_size() / 2;
  const double by_pieces = triangles_by_pieces(request);
  const double triangles =
      std::min(triangles_by_size(request) + by_pieces + kTrianglesPerPoint * points,
               static_cast<double>(most_triangles));
  const bool may_stream = !capped && min_angle_of(request) <= kMostStreamingAngleDeg;
  const double bytes = kBytesPerRun + kBytesPerPoint * points + bytes_to_expect(request.size()) +
                       bytes_of_mesh(triangles, may_stream);
  // Not `min` alone: coordinates that are not finite make it NaN.
  return bytes < static_cast<double>(most) ? static_cast<std::uint64_t>(bytes) : most;
}

}  // namespace weft::server

// SPDX-License-Identifier: Apache-2.0
#include "server/admission/memory_estimate.h"

#include <algorithm>
#include <cmath>

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
// Of the largest chunk, tables and buffers, in any run.
constexpr double kBytesPerRun = 1.5e6;
// Triangles times the bound over the area, at circumcentres: 1.55 if the size is the same
// everywhere. Where it changes within a few triangles there are up to half more. Angles alone ask
// for about four triangles a point.
constexpr double kTrianglesPerArea = 1.8;
constexpr double kOnLattice = 1.52;  // times one over the part of the bound that its triangles fill
constexpr double kTrianglesPerPoint = 4;

// Of a mesh that leaves while it is refined (engine/schedule/mesh_run.h): a strip of leaves is
// held, and what each leaf has all the time. Measured with 10 M to 1,000 M triangles: 370 for a
// size that grows with the distance from something, up to half more for one that is the same
// everywhere.
constexpr double kMostStreamingAngleDeg = 30;
constexpr double kFewestLeaves = 64;
constexpr double kBytesOfStrip = 420;  // times the root of triangles of the mesh and of a leaf
constexpr double kBytesPerLeaf = 2700;

double triangles_of_leaf(double triangles) {
  const double fewer = 3.2e10 / triangles;
  return std::clamp(fewer, std::clamp(0.4 * std::sqrt(triangles), 6'000.0, 16'000.0), 16'000.0);
}

double inverse(double bound) {
  return bound > 0 ? 1 / bound : 0;  // what is no bound is for the engine to refuse
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

// The integral of 1 / bound over the domain, for the size and the bounds of its regions.
double integral(const DomainPicture& picture, const SizeFunction& size) {
  constexpr int kCells = DomainPicture::kCells;
  double sum = 0;
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
    for (int column = 0; column < kCells; ++column)
      sum += picture.part_inside(column, row) *
             std::max(inverse(bounds[column]), inverse(picture.max_area(column, row)));
  }
  return sum * picture.area_of_cell();
}

// What the size and the regions ask for.
double triangles_by_size(const v1::GenerateMeshRequest& request) {
  const DomainPicture picture = DomainPicture::of(request.domain());
  const double over_bound = integral(picture, size_to_estimate_by(request.size()).function());
  const double fill = fill_of_lattice(request);
  return over_bound * (fill > 0 ? kOnLattice / fill : kTrianglesPerArea);
}

// Of a mesh that is held as a whole, or of the strip that is.
double bytes_of_mesh(double triangles, bool may_stream) {
  const double whole = kBytesPerTriangle * triangles;
  const double of_leaf = triangles_of_leaf(triangles);
  const double leaves = triangles / of_leaf;
  if (!may_stream || leaves < kFewestLeaves) return whole;
  return std::min(whole, kBytesOfStrip * std::sqrt(triangles * of_leaf) + kBytesPerLeaf * leaves);
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
  const double triangles = std::min(triangles_by_size(request) + kTrianglesPerPoint * points,
                                    static_cast<double>(most_triangles));
  const bool may_stream = !capped && min_angle_of(request) <= kMostStreamingAngleDeg;
  const double bytes = kBytesPerRun + kBytesPerPoint * points + bytes_to_expect(request.size()) +
                       bytes_of_mesh(triangles, may_stream);
  // Not `min` alone: coordinates that are not finite make it NaN.
  return bytes < static_cast<double>(most) ? static_cast<std::uint64_t>(bytes) : most;
}

}  // namespace weft::server

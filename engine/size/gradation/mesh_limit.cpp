// SPDX-License-Identifier: Apache-2.0
#include "engine/size/gradation/mesh_limit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <utility>
#include <vector>

#include "engine/size/box_overlap.h"
#include "engine/size/fields/polled_loop.h"
#include "engine/size/gradation/mesh_paths.h"

namespace weft {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The least length of edges that matters in a triangle; infinity if none does.
class LeastIn {
 public:
  LeastIn(const SizeFunction& size, double gradation) : size_(size), gradation_(gradation) {}

  double operator()(const Corners& c) const { return least(c, kDepth); }

 private:
  static constexpr int kDepth = 2;
  static constexpr double kFar = 1.25;
  static constexpr double kSlack = 1e-9;

  double least(const Corners& c, int depth) const {
    Box box;
    for (const Point p : c) box.add(p);
    const Interval areas = size_.bounds(box);
    if (areas.lo > areas.hi || !(areas.hi > 0)) return kInfinity;
    const double lo = areas.lo > 0 ? SizeFunction::edge_of_area(areas.lo) : 0;
    if (lo > 0 && !areas.may_be_nan && areas.lo < areas.hi &&
        size_.edge_steepness(box) <= gradation_ * (1 + kSlack))
      return kInfinity;
    if (lo > 0 && (depth == 0 || SizeFunction::edge_of_area(areas.hi) <= kFar * lo)) return lo;
    if (depth == 0) {
      const double area = size_(centroid(c[0], c[1], c[2]));
      return area > 0 ? SizeFunction::edge_of_area(area) : kInfinity;
    }
    const auto between = [](Point p, Point q) {
      return Point{p.x + 0.5 * (q.x - p.x), p.y + 0.5 * (q.y - p.y)};
    };
    const Corners m{between(c[1], c[2]), between(c[2], c[0]), between(c[0], c[1])};
    double found = least(m, depth - 1);
    for (unsigned k = 0; k < 3; ++k)
      found = std::min(found, least({c[k], m[(k + 2) % 3], m[(k + 1) % 3]}, depth - 1));
    return found;
  }

  const SizeFunction& size_;
  const double gradation_;
};

// Brings the slopes of triangles down to a limit that most of them keep to already, each by a small
// change of its corners, until all do: S. Kaczmarz's projections (1937). What one triangle needs
// spreads among its neighbours, and ends where their slopes leave room for it.
class SlopeLimiter {
 public:
  // No value of the mesh is raised above that in `most`.
  SlopeLimiter(double limit, FieldMesh& mesh, const VertexTriangles& triangles,
               const std::vector<double>& most);

  // Whether all triangles keep to the limit in the end.
  Result<bool> run(const ExecutionContext& context);
  double steepest() const;

 private:
  static constexpr std::size_t kMaxLooks = 40;  // per triangle

  double slope(std::uint32_t t) const;
  bool settle(std::uint32_t t);

  const double limit_;
  FieldMesh& mesh_;
  const VertexTriangles& triangles_;
  const std::vector<double>& most_;
  std::vector<double> shortest_;  // edge of each vertex
};

SlopeLimiter::SlopeLimiter(double limit, FieldMesh& mesh, const VertexTriangles& triangles,
                           const std::vector<double>& most)
    : limit_(limit),
      mesh_(mesh),
      triangles_(triangles),
      most_(most),
      shortest_(mesh.vertices.size(), kInfinity) {
  for (const auto& t : mesh.triangles)
    for (unsigned k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k];
      const std::uint32_t b = t[(k + 1) % 3];
      const double length = std::sqrt(distance2(mesh.vertices[a], mesh.vertices[b]));
      for (const std::uint32_t v : {a, b}) shortest_[v] = std::min(shortest_[v], length);
    }
}

// NaN if values are infinite.
double SlopeLimiter::slope(std::uint32_t t) const {
  const auto& v = mesh_.triangles[t];
  const Point a = mesh_.vertices[v[0]];
  const Point b = mesh_.vertices[v[1]];
  const Point c = mesh_.vertices[v[2]];
  const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  const double to_b = mesh_.values[v[1]] - mesh_.values[v[0]];
  const double to_c = mesh_.values[v[2]] - mesh_.values[v[0]];
  const double x = (to_b * (c.y - a.y) - to_c * (b.y - a.y)) / area;
  const double y = (to_c * (b.x - a.x) - to_b * (c.x - a.x)) / area;
  return std::sqrt(x * x + y * y);
}

double SlopeLimiter::steepest() const {
  double found = 0;
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) found = std::max(found, slope(t));
  return found;
}

// Returns false if the triangle keeps to the limit. Corners with short edges move less, because a
// small step there is steep.
bool SlopeLimiter::settle(std::uint32_t t) {
  constexpr double kLess = 0.995;  // so that it ends sooner
  const double steep = slope(t);
  if (!(steep > limit_)) return false;
  double mean = 0;
  double weights = 0;
  for (const std::uint32_t v : mesh_.triangles[t]) {
    mean += mesh_.values[v] / shortest_[v];
    weights += 1 / shortest_[v];
  }
  mean /= weights;
  const double share = kLess * limit_ / steep;
  double over = 0;
  for (const std::uint32_t v : mesh_.triangles[t]) {
    mesh_.values[v] = mean + share * (mesh_.values[v] - mean);
    over = std::max(over, mesh_.values[v] - most_[v]);
  }
  for (const std::uint32_t v : mesh_.triangles[t]) mesh_.values[v] -= over;
  return true;
}

Result<bool> SlopeLimiter::run(const ExecutionContext& context) {
  constexpr std::size_t kPollInterval = 1 << 12;
  std::deque<std::uint32_t> open;
  std::vector<bool> listed(mesh_.triangles.size(), false);
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    if (!(slope(t) > limit_)) continue;
    open.push_back(t);
    listed[t] = true;
  }
  for (std::size_t i = 0; !open.empty(); ++i) {
    if (i > kMaxLooks * mesh_.triangles.size()) return false;
    if (i % kPollInterval == 0) {
      if (auto error = context.poll()) return tl::unexpected(std::move(*error));
    }
    const std::uint32_t t = open.front();
    open.pop_front();
    listed[t] = false;
    if (!settle(t)) continue;
    for (const std::uint32_t v : mesh_.triangles[t])
      triangles_.around(v, [&](std::uint32_t beside) {
        if (beside == t || listed[beside]) return;
        open.push_back(beside);
        listed[beside] = true;
      });
  }
  return true;
}

}  // namespace

std::optional<Error> lower_to_size(const SizeFunction& size, double gradation, FieldMesh& mesh,
                                   const ExecutionContext& context) {
  constexpr std::size_t kAtATime = 64;  // triangles
  const LeastIn least_in(size, gradation);
  std::vector<double> least(mesh.triangles.size());
  if (auto error =
          polled_loop(context, (least.size() + kAtATime - 1) / kAtATime, [&](std::size_t group) {
            const std::size_t end = std::min((group + 1) * kAtATime, least.size());
            for (std::size_t t = group * kAtATime; t < end; ++t) {
              const auto& [a, b, c] = mesh.triangles[t];
              least[t] = least_in({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
            }
          }))
    return error;
  for (std::size_t t = 0; t < least.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t])
      mesh.values[v] = std::min(mesh.values[v], least[t]);
  return std::nullopt;
}

// Paths are taken a little too short, so that there is room where slopes have to come down, and
// shorter still while that does not suffice. Whatever comes of it, the limit holds in the end.
std::optional<Error> limit_slopes(double gradation, FieldMesh& mesh,
                                  const ExecutionContext& context) {
  constexpr double kRoom = 0.03;
  constexpr double kMoreRoom = 0.003;
  constexpr int kTries = 16;
  constexpr double kRounding = 1e-9;
  const auto shrink = [&](double share) {
    for (double& value : mesh.values) value *= share;
  };
  const std::vector<double> most = mesh.values;
  const VertexTriangles triangles(mesh);
  if (auto error = MeshPaths(mesh, triangles, gradation).run(context)) return error;
  SlopeLimiter limiter(gradation, mesh, triangles, most);
  shrink(1 - kRoom);
  for (int i = 0; i < kTries; ++i) {
    const Result<bool> done = limiter.run(context);
    if (!done) return done.error();
    if (*done) break;
    shrink(1 - kMoreRoom);
  }
  shrink((1 - kRounding) / std::max(1.0, limiter.steepest() / gradation));
  return std::nullopt;
}

}  // namespace weft

// SPDX-License-Identifier: Apache-2.0
// Finds where in its star a vertex makes the triangles around it equally large for their bounds.
//
//   StarCost star(0.1786F);   // the squared sine of 25 degrees
//   star.begin(6, edge);
//   for (std::uint32_t i = 0; i <= 6; ++i) star.set_point(i, x[i % 6], y[i % 6]);
//   for (std::uint32_t i = 0; i < 6; ++i) star.set_bound(i, largest_area);
//   if (const auto place = star.search()) ...   // relative to where the vertex is
//
// Let f be a triangle's area over its bound, q = 4 sqrt(3) area / (sum of the squared edges) and a
// its smallest angle. A star costs the sum over its triangles of
//
//   0.3 (1 / q - 1) + P(f / 0.92) / 2 + 4 max(0, sin^2(least) / sin^2(a) - 1)
//
// where P(x) is x^8 / 8 up to 1, and x^16 / 16 + 1 / 16 above. Whatever the vertices do, the sum of
// f over a mesh stays nearly the same, so a convex function of it drives all to be equal. The
// search tries eight places on the way to, and beyond, the mean of the triangles' centroids,
// weighted by f^4; in floats, in units of the triangles' edge. So its result is a proposal, which
// the caller judges in full precision. Not thread-safe: one per task.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "engine/base/vector.h"
#include "engine/refine/smoothing/eight_floats.h"

namespace weft {

class StarCost {
 public:
  static constexpr std::uint32_t kMaxEdges = 16;  // of a link

  // Angles whose squared sine is below this cost extra.
  explicit StarCost(float least_sin2) : least_sin2_(least_sin2) {}

  // The number of edges in the link, and a length near theirs.
  void begin(std::uint32_t edges, double edge) {
    size_ = edges;
    edge_ = edge;
    per_edge_ = 1 / edge;
  }
  // Sets point i of the link, relative to the vertex. Point 0 must be repeated as the last.
  void set_point(std::uint32_t i, double x, double y) {
    x_[i] = static_cast<float>(x * per_edge_);
    y_[i] = static_cast<float>(y * per_edge_);
  }
  // Sets the bound on the area of the triangle at the points i and i + 1.
  void set_bound(std::uint32_t i, double area) {
    per_bound_[i] = static_cast<float>(0.5 / (area * per_edge_ * per_edge_));
  }

  // The best place; none if none costs less than where the vertex is.
  std::optional<Vector> search() const {
    using E = EightFloats;
    const auto [mean_x, mean_y] = mean_of_centroids();
    const E x = E::all(mean_x) * E::of(kOnTheWay);
    const E y = E::all(mean_y) * E::of(kOnTheWay);
    const E cost = cost_at(x, y);
    const float now = cost.lane(0);
    int lane = 0;
    const float most = (E::all(0) - cost).largest(lane);
    if (!(-most < kLessThan * now)) return std::nullopt;
    return Vector{edge_ * x.lane(lane), edge_ * y.lane(lane)};
  }

 private:
  static constexpr float kOnTheWay[8] = {0, 1, 0.5F, 0.75F, 0.25F, 1.25F, 1.5F, 2};
  static constexpr float kLessThan = 0.9999F;  // times the cost now
  static constexpr float kAim = 0.92F;         // of the bound
  static constexpr float kNever = 1e30F;

  EightFloats cost_at(EightFloats x, EightFloats y) const {
    using E = EightFloats;
    constexpr float kShape = 0.3F / 3.4641016F;  // area is doubled
    const E zero = E::all(0);
    const E one = E::all(1);
    E sum = zero;
    E ax = E::all(x_[0]) - x;
    E ay = E::all(y_[0]) - y;
    E a2 = ax * ax + ay * ay;
    for (std::uint32_t i = 0; i < size_; ++i) {
      const E bx = E::all(x_[i + 1]) - x;
      const E by = E::all(y_[i + 1]) - y;
      const E b2 = bx * bx + by * by;
      const E ex = bx - ax;
      const E ey = by - ay;
      const E e2 = ex * ex + ey * ey;
      const E area = ax * by - ay * bx;
      const E per_area = one / max(area, E::all(1e-6F));
      const E shape = (a2 + b2 + e2) * per_area;
      const E aimed = area * E::all(per_bound_[i] / kAim);
      const E aimed2 = aimed * aimed;
      const E aimed4 = aimed2 * aimed2;
      const E aimed8 = aimed4 * aimed4;
      const E large = select(aimed > one, E::all(1.0F / 32) * (aimed8 * aimed8 + one),
                             E::all(1.0F / 16) * aimed8);
      const E per_sine2 = a2 * b2 * e2 * per_area * per_area / min(min(a2, b2), e2);
      const E thin = max(E::all(4 * least_sin2_) * per_sine2 - E::all(4), zero);
      sum = sum + E::all(kShape) * shape + large + thin +
            select(area > E::all(1e-6F), zero, E::all(kNever));
      ax = bx;
      ay = by;
      a2 = b2;
    }
    return sum;
  }

  std::pair<float, float> mean_of_centroids() const {
    float sum = 0;
    float x = 0;
    float y = 0;
    for (std::uint32_t i = 0; i < size_; ++i) {
      const float f = (x_[i] * y_[i + 1] - y_[i] * x_[i + 1]) * per_bound_[i];
      const float weight = f * f * (f * f);
      x += weight * (x_[i] + x_[i + 1]);
      y += weight * (y_[i] + y_[i + 1]);
      sum += weight;
    }
    const float per_sum = sum > 0 ? 1 / (3 * sum) : 0;
    return {x * per_sum, y * per_sum};
  }

  float least_sin2_;
  std::uint32_t size_ = 0;
  double edge_ = 1;
  double per_edge_ = 1;
  float x_[kMaxEdges + 1] = {};  // of the link, relative to the vertex, in edges
  float y_[kMaxEdges + 1] = {};
  float per_bound_[kMaxEdges] = {};  // of doubled areas
};

}  // namespace weft

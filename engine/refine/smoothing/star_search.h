// SPDX-License-Identifier: Apache-2.0
// Finds where in its star a vertex makes the smallest angle around it largest.
//
//   StarSearch star;
//   star.begin(6, edge);
//   for (std::uint32_t i = 0; i <= 6; ++i) star.set_point(i, x[i % 6], y[i % 6]);
//   for (std::uint32_t i = 0; i < 6; ++i) star.set_bound(i, largest_area);
//   const StarSearch::Place place = star.search();  // relative to where the vertex is
//
// A star's worth is that of its worst triangle: the squared sine of the smallest angle, a quarter
// of it if the largest is over 122.7 degrees. The search tries eight places at a time: first
// toward the mean of the equilateral apexes over the link's edges, weighted by how bad each
// triangle is, then around the best place so far. It works in floats, in units of the triangles'
// edge, so its result is a proposal, which the caller judges in full precision.
//
// It makes 32 trials, without a branch within one, because the processor cannot predict where a
// trial would end. Not thread-safe: one per task.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

#include "engine/refine/smoothing/eight_floats.h"

namespace weft {

class StarSearch {
 public:
  static constexpr std::uint32_t kMaxEdges = 16;  // of a link
  // The squared sine of 48 degrees: the worth at which a star is good enough.
  static constexpr float kGoodEnough = 0.5523F;

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
  // Sets the bound on the area of the triangle at the points i and i + 1. REQUIRES: both are set.
  void set_bound(std::uint32_t i, double area) {
    const float x = x_[i + 1] - x_[i];
    const float y = y_[i + 1] - y_[i];
    edge2_[i] = x * x + y * y;
    bound_[i] = static_cast<float>(2 * area * per_edge_ * per_edge_);
  }

  struct Place {
    double x;
    double y;
    float gain;  // the star's worth there over its worth now; 0 if there is nothing to gain
  };

  Place search() const {
    using E = EightFloats;
    const auto [apex_x, apex_y] = mean_of_apexes();
    E x = E::all(apex_x) * E::of(kTowardApex);
    E y = E::all(apex_y) * E::of(kTowardApex);
    E worth = worth_at(x, y);
    const float now = worth.lane(0);
    if (!(now > 0 && now < kGoodEnough)) return {0, 0, 0};
    float best = now;
    float best_x = 0;
    float best_y = 0;
    float step = kFirstStep;
    for (int round = 0;; ++round) {
      int lane = 0;
      const float most = worth.largest(lane);
      if (most > best) {
        best = most;
        best_x = x.lane(lane);
        best_y = y.lane(lane);
      }
      if (round == kRounds || best >= kGoodEnough) break;
      if (round > 0 || most > now) step *= 0.5F;
      x = E::all(best_x) + E::all(step) * E::of(kAroundX);
      y = E::all(best_y) + E::all(step) * E::of(kAroundY);
      worth = worth_at(x, y);
    }
    return {edge_ * best_x, edge_ * best_y, best / now};
  }

 private:
  static constexpr int kRounds = 3;  // around the best place
  static constexpr float kFirstStep = 0.25F;
  static constexpr float kTowardApex[8] = {0, 1, 0.5F, 0.75F, 0.25F, 1.25F, 0.125F, 1.5F};
  static constexpr float kAroundX[8] = {1, 0.7071F, 0, -0.7071F, -1, -0.7071F, 0, 0.7071F};
  static constexpr float kAroundY[8] = {0, 0.7071F, 1, 0.7071F, 0, -0.7071F, -1, -0.7071F};
  static constexpr float kObtuse = 4 * 0.2919F;  // 4 times the squared cosine of 122.7 degrees

  // The star's worth with its vertex at each of the places; 0 if a triangle would be flat or too
  // large.
  EightFloats worth_at(EightFloats x, EightFloats y) const {
    using E = EightFloats;
    const E zero = E::all(0);
    E worst = E::all(1);
    E too_large = E::all(-1);
    E ax = E::all(x_[0]) - x;
    E ay = E::all(y_[0]) - y;
    E a2 = ax * ax + ay * ay;
    for (std::uint32_t i = 0; i < size_; ++i) {
      const E bx = E::all(x_[i + 1]) - x;
      const E by = E::all(y_[i + 1]) - y;
      const E b2 = bx * bx + by * by;
      const E c2 = E::all(edge2_[i]);
      const E area = ax * by - ay * bx;
      too_large = max(too_large, area - E::all(bound_[i]));
      const E product = a2 * b2 * c2;
      const E longest = max(max(a2, b2), c2);
      const E excess = longest + longest - (a2 + b2 + c2);
      const E obtuse = excess * max(excess, zero) * longest > E::all(kObtuse) * product;
      const E sine2 = area * max(area, zero) * min(min(a2, b2), c2) / product;
      worst = min(worst, sine2 - (obtuse & (sine2 * E::all(0.75F))));
      ax = bx;
      ay = by;
      a2 = b2;
    }
    return select(too_large > zero, zero, worst);
  }

  // The mean apex of the equilateral triangles on the link's edges; the apex of a worse triangle
  // has a larger weight.
  std::pair<float, float> mean_of_apexes() const {
    constexpr float kHeight = 0.8660254F;
    constexpr float kEvenly = 0.05F;
    float sum = 0;
    float x = 0;
    float y = 0;
    for (std::uint32_t i = 0; i < size_; ++i) {
      const float a2 = x_[i] * x_[i] + y_[i] * y_[i];
      const float b2 = x_[i + 1] * x_[i + 1] + y_[i + 1] * y_[i + 1];
      const float area = x_[i] * y_[i + 1] - y_[i] * x_[i + 1];
      const float product = a2 * b2 * edge2_[i];
      const float root =
          product / (area * area * std::min(std::min(a2, b2), edge2_[i]) + kEvenly * product);
      const float weight = root * root;
      x += weight * (0.5F * (x_[i] + x_[i + 1]) - kHeight * (y_[i + 1] - y_[i]));
      y += weight * (0.5F * (y_[i] + y_[i + 1]) + kHeight * (x_[i + 1] - x_[i]));
      sum += weight;
    }
    return {x / sum, y / sum};
  }

  std::uint32_t size_ = 0;
  double edge_ = 1;
  double per_edge_ = 1;
  float x_[kMaxEdges + 1] = {};  // of the link, relative to the vertex, in edges
  float y_[kMaxEdges + 1] = {};
  float edge2_[kMaxEdges] = {};
  float bound_[kMaxEdges] = {};  // doubled, as areas are
};

}  // namespace weft

// SPDX-License-Identifier: Apache-2.0
// A grading function: the upper bound on a triangle's area, in squared units, as a function of its
// centroid. Its bounds over boxes guide the refinement (size_map.h).
#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/size/field.h"
#include "weft/size.h"

namespace weft {

class SizeFunction : public Field {
 public:
  // The inverse of area_of_edge.
  static double edge_of_area(double area) { return std::sqrt(area / 0.4330127018922193); }

  // The lesser of an area and that of an edge; NaN if the area is.
  static double least(double area, double edge) {
    const double of_edge = area_of_edge(edge);
    return of_edge < area ? of_edge : area;
  }

  // A size that varies must be finite, also in a part of the domain that no limit reaches: there
  // edges have this length, and triangles count as unbounded.
  static constexpr double kUnreachedEdge = 1e50;
  static bool bounds_area(double area) {
    constexpr double kUnreached = 0.4330127018922193 * kUnreachedEdge * kUnreachedEdge;
    constexpr double kRounding = 1e-6;  // of an interpolation
    return area < (1 - kRounding) * kUnreached ||
           ((1 + kRounding) * kUnreached < area && area < std::numeric_limits<double>::infinity());
  }

  // Field::steepness of the length of edges, edge_of_area of the value: by the chain rule.
  virtual double edge_steepness(const Box& box) const noexcept {
    const double steep = steepness(box);
    if (steep == 0) return 0;
    const double least = bounds(box).lo;
    if (!(least > 0)) return std::numeric_limits<double>::infinity();
    return steep / (2 * area_of_edge(1) * edge_of_area(least));
  }

  // The value, if it is known to be the same everywhere; infinity for no bound.
  virtual std::optional<double> constant() const noexcept { return std::nullopt; }

  // The size as a function of the field's value alone: at (v, 0) what this is where the field is v.
  // Null if it depends on anything else. Refers to nothing of this.
  virtual std::unique_ptr<const SizeFunction> along(const Field& field) const {
    static_cast<void>(field);
    return nullptr;
  }

  // What a request asks for at p, before limits: for errors.
  struct Asked {
    double value;
    bool is_edge = false;                  // a length, not an area
    std::vector<std::string> undefined{};  // the fields, such as "depth", that are undefined at p
  };
  virtual Asked asked_at(Point p) const { return {(*this)(p)}; }
};

}  // namespace weft

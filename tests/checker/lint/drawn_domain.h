// SPDX-License-Identifier: Apache-2.0
// A domain that a test draws, and the faults found in it.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "checker/lint/lint.h"

namespace weft::check {

class DrawnDomain {
 public:
  DrawnDomain& line(std::initializer_list<Vec2> points) {
    const auto first = static_cast<std::uint32_t>(domain.points.size());
    domain.points.insert(domain.points.end(), points);
    for (std::uint32_t i = first; i + 1 < domain.points.size(); ++i) add(i, i + 1);
    return *this;
  }
  DrawnDomain& ring(std::initializer_list<Vec2> points) {
    const auto first = static_cast<std::uint32_t>(domain.points.size());
    line(points);
    add(static_cast<std::uint32_t>(domain.points.size() - 1), first);
    return *this;
  }
  DrawnDomain& box(Vec2 low, Vec2 high) {
    return ring({low, {high.x, low.y}, high, {low.x, high.y}});
  }
  // Rings from now on are the borders of another polygon; `is_hole` carves.
  DrawnDomain& polygon(bool is_hole = false) {
    domain.areas.push_back({.region = {}, .priority = 0, .max_area = {}, .is_hole = is_hole});
    domain.segment_areas.resize(domain.segments.size());
    domain.fill = Fill::kUnion;
    of_area_ = static_cast<std::uint32_t>(domain.areas.size());
    return *this;
  }
  // Lines from now on are of no polygon.
  DrawnDomain& no_polygon() {
    of_area_ = 0;
    return *this;
  }

  Faults faults(bool shared_points = false) const { return lint(domain, shared_points).faults; }
  // "gap 1, crossing 2".
  std::string told(bool shared_points = false) const {
    const Faults found = faults(shared_points);
    std::string text;
    for (std::size_t kind = 0; kind < kFaultKinds; ++kind)
      if (const auto total = found.total(static_cast<FaultKind>(kind)); total > 0)
        text += (text.empty() ? "" : ", ") + std::string(fault_name(static_cast<FaultKind>(kind))) +
                " " + std::to_string(total);
    return text;
  }

  Domain domain;

 private:
  void add(std::uint32_t a, std::uint32_t b) {
    domain.segments.push_back({a, b});
    if (!domain.areas.empty()) domain.segment_areas.push_back(of_area_);
  }
  std::uint32_t of_area_ = 0;
};

}  // namespace weft::check

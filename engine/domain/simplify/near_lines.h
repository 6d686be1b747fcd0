// SPDX-License-Identifier: Apache-2.0
// Distances to the lines of the original domain: a tree of boxes over the lines along a Hilbert
// curve. Simplification goes over the domain several times and finds most triangles as they were,
// so what was found of a triangle is remembered. Not thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/base/geometry.h"
#include "engine/domain/simplify/line_graph.h"
#include "engine/domain/stop_poller.h"

namespace weft {

class NearLines {
 public:
  // Throws Stopped.
  NearLines(const LineGraph& graph, StopPoller& poller);

  // Which lines count: those with this marker, or all.
  using Marker = std::optional<std::int32_t>;

  // The distance of p to the nearest line; `within` if none is nearer than that.
  double distance(Point p, double within, Marker marker = std::nullopt) const;

  // Whether every point of the triangle is within a distance of the lines. May say no if one is
  // farther than 15/16 of it, or if the triangle is far larger. It may be flat.
  bool holds_near(const std::array<Point, 3>& triangle, double within,
                  Marker marker = std::nullopt) const;

  // A bound on the distance of the farthest point between a and b: at most a 16th of `within` more.
  // REQUIRES: none is farther than `within`.
  double farthest(Point a, Point b, double within) const;

 private:
  static constexpr std::size_t kLeaf = 4;  // lines

  struct Marked {
    Point a, b;
    std::int32_t marker;
  };
  struct Asked {
    std::array<Point, 3> triangle{};
    double within = -1;
    Marker marker{};
    bool is_near = false;
    bool is_for(const Asked& other) const {
      return triangle == other.triangle && within == other.within && marker == other.marker;
    }
  };
  std::size_t place_of(const Asked& asked) const;
  bool find_near(const Asked& asked) const;

  // The distance of p to the nearest line, or to one that is at most `enough` away; `within` if
  // none is nearer than that. Tries `line` first, unless that is kNoLine, and sets it to what it
  // finds.
  double distance(Point p, double within, Marker marker, double enough, std::size_t& line) const;

  static constexpr std::size_t kNoLine = ~std::size_t{0};

  std::vector<Marked> lines_;  // in the order of the leaves
  std::size_t leaves_ = 1;     // as in PointTree
  std::vector<Box> box_;
  mutable std::vector<Asked> known_;  // what holds_near found, the last one for each place
};

}  // namespace weft

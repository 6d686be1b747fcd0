// SPDX-License-Identifier: Apache-2.0
// The vertices of an arrangement of segments: end points, which are doubles, and crossing points,
// which are rational. They are numbered in lexicographic order (x, then y), exactly, and points
// that coincide have one number. Along a segment the numbers rise or fall.
//
// Crossing points are compared by their nearest doubles first, by integers if those are close.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <cstdint>
#include <span>
#include <vector>

#include "checker/domain.h"
#include "checker/geometry/contacts.h"

namespace weft::check {

class VertexOrder {
 public:
  VertexOrder(std::span<const Vec2> points, std::span<const SegmentEnds> segments,
              const Contacts& contacts);

  std::uint32_t size() const { return static_cast<std::uint32_t>(vertices_.size()); }
  // The number of a point that is an end of a segment.
  std::uint32_t of_point(std::uint32_t point) const { return of_point_[point]; }
  std::uint32_t of_crossing(std::uint32_t crossing) const { return of_crossing_[crossing]; }
  // An end point itself; a crossing to within two units in the last place of each coordinate.
  Vec2 at(std::uint32_t vertex) const { return vertices_[vertex].at; }
  bool is_crossing(std::uint32_t vertex) const { return vertices_[vertex].exact != kDouble; }

  // Exact: < 0, 0 or > 0 if the vertex is lower than, level with or higher than y.
  int compare_y(std::uint32_t vertex, double y) const;
  // Exact, in lexicographic order.
  int compare(std::uint32_t vertex, Vec2 p) const;

 private:
  using Integer = boost::multiprecision::cpp_int;
  static constexpr std::uint32_t kDouble = 0xffffffffu;

  struct Vertex {
    Vec2 at;
    std::uint32_t exact;  // index into rationals_, or kDouble
  };
  // (x / w, y / w) times 2^exponent_, w > 0.
  struct Rational {
    Integer x, y, w;
  };

  Rational crossing_of(Vec2 a, Vec2 b, Vec2 c, Vec2 d) const;
  Vec2 nearest(const Rational& p) const;
  int compare_exactly(const Integer& numerator, const Integer& denominator, double value) const;
  int compare(const Vertex& p, const Vertex& q) const;

  int exponent_ = 0;  // every coordinate of an end point is a multiple of 2^exponent_
  std::vector<Rational> rationals_;
  std::vector<Vertex> vertices_;
  std::vector<std::uint32_t> of_point_;
  std::vector<std::uint32_t> of_crossing_;
};

}  // namespace weft::check

// SPDX-License-Identifier: Apache-2.0
#include "checker/geometry/vertex_order.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "checker/geometry/predicates.h"

namespace weft::check {
namespace {

using Integer = boost::multiprecision::cpp_int;

// numerator / denominator * 2^exponent, to within two units in the last place.
double quotient(const Integer& numerator, const Integer& denominator, int exponent) {
  if (numerator == 0) return 0;
  const Integer magnitude = abs(numerator);
  const int shift = 64 + static_cast<int>(msb(denominator)) - static_cast<int>(msb(magnitude));
  const Integer scaled = shift >= 0
                             ? Integer((magnitude << shift) / denominator)
                             : Integer(magnitude / (denominator << -shift));  // 64 or 65 bits
  const double value = std::ldexp((scaled >> 2).convert_to<double>(), exponent - shift + 2);
  return numerator < 0 ? -value : value;
}

// -1 or 1 if the doubles are so far apart that what they approximate is in the same order, else 0.
int order_of_approximations(double p, double q) {
  const double error = 0x1p-49 * (std::fabs(p) + std::fabs(q));
  return p - q > error ? 1 : q - p > error ? -1 : 0;
}

int order(double p, double q) {
  return (p > q) - (p < q);
}

}  // namespace

VertexOrder::VertexOrder(std::span<const Vec2> points, std::span<const SegmentEnds> segments,
                         const Contacts& contacts)
    : of_point_(points.size(), 0), of_crossing_(contacts.crossings.size(), 0) {
  std::vector<char> is_end(points.size(), 0);
  for (const auto [a, b] : segments) is_end[a] = is_end[b] = 1;

  // Where the numbers go, one for each vertex before merging.
  std::vector<std::uint32_t*> numbers;
  std::vector<Vertex> all;
  exponent_ = std::numeric_limits<int>::max();
  for (std::uint32_t p = 0; p < points.size(); ++p) {
    if (!is_end[p]) continue;
    for (const double coordinate : {points[p].x, points[p].y})
      if (coordinate != 0) exponent_ = std::min(exponent_, decompose(coordinate).exponent);
    all.push_back({points[p], kDouble});
    numbers.push_back(&of_point_[p]);
  }
  rationals_.reserve(contacts.crossings.size());
  for (std::uint32_t k = 0; k < contacts.crossings.size(); ++k) {
    const auto [a, b] = segments[contacts.crossings[k].first];
    const auto [c, d] = segments[contacts.crossings[k].second];
    rationals_.push_back(crossing_of(points[a], points[b], points[c], points[d]));
    all.push_back({nearest(rationals_[k]), k});
    numbers.push_back(&of_crossing_[k]);
  }

  std::vector<std::uint32_t> sorted(all.size());
  std::iota(sorted.begin(), sorted.end(), 0u);
  // Where a crossing coincides with an end point, the end point comes first and stands for both.
  std::sort(sorted.begin(), sorted.end(), [&](std::uint32_t i, std::uint32_t j) {
    const int order = compare(all[i], all[j]);
    return order != 0 ? order < 0 : i < j;
  });
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    const Vertex& vertex = all[sorted[k]];
    if (k == 0 || compare(vertices_.back(), vertex) != 0) vertices_.push_back(vertex);
    *numbers[sorted[k]] = size() - 1;
  }
}

VertexOrder::Rational VertexOrder::crossing_of(Vec2 a, Vec2 b, Vec2 c, Vec2 d) const {
  const auto integer = [this](double value) -> Integer {
    const Dyadic parts = decompose(value);
    if (parts.mantissa == 0) return 0;
    return Integer(parts.mantissa) << (parts.exponent - exponent_);
  };
  const Integer ax = integer(a.x), ay = integer(a.y);
  const Integer cx = integer(c.x), cy = integer(c.y);
  const Integer ux = integer(b.x) - ax, uy = integer(b.y) - ay;
  const Integer vx = integer(d.x) - cx, vy = integer(d.y) - cy;
  Integer w = ux * vy - uy * vx;  // not 0: the segments cross
  Integer t = (cx - ax) * vy - (cy - ay) * vx;
  if (w < 0) {
    w = -w;
    t = -t;
  }
  return {ax * w + ux * t, ay * w + uy * t, w};
}

Vec2 VertexOrder::nearest(const Rational& p) const {
  return {quotient(p.x, p.w, exponent_), quotient(p.y, p.w, exponent_)};
}

int VertexOrder::compare_exactly(const Integer& numerator, const Integer& denominator,
                                 double value) const {
  const Dyadic parts = decompose(value);
  if (parts.mantissa == 0) return numerator.sign();
  const Integer other = denominator * parts.mantissa;
  const int shift = parts.exponent - exponent_;
  return shift >= 0 ? numerator.compare(Integer(other << shift))
                    : Integer(numerator << -shift).compare(other);
}

int VertexOrder::compare(const Vertex& p, const Vertex& q) const {
  if (p.exact == kDouble && q.exact == kDouble) {
    const int by_x = order(p.at.x, q.at.x);
    return by_x != 0 ? by_x : order(p.at.y, q.at.y);
  }
  for (const bool by_x : {true, false}) {
    const double p_near = by_x ? p.at.x : p.at.y;
    const double q_near = by_x ? q.at.x : q.at.y;
    int result = order_of_approximations(p_near, q_near);
    if (result != 0) return result;
    const auto numerator = [by_x](const Rational& r) -> const Integer& { return by_x ? r.x : r.y; };
    if (q.exact == kDouble) {
      const Rational& r = rationals_[p.exact];
      result = compare_exactly(numerator(r), r.w, q_near);
    } else if (p.exact == kDouble) {
      const Rational& r = rationals_[q.exact];
      result = -compare_exactly(numerator(r), r.w, p_near);
    } else {
      const Rational& r = rationals_[p.exact];
      const Rational& s = rationals_[q.exact];
      result = Integer(numerator(r) * s.w).compare(Integer(numerator(s) * r.w));
    }
    if (result != 0) return result;
  }
  return 0;
}

int VertexOrder::compare(std::uint32_t vertex, Vec2 p) const {
  return compare(vertices_[vertex], {p, kDouble});
}

int VertexOrder::compare_y(std::uint32_t vertex, double y) const {
  const Vertex& v = vertices_[vertex];
  if (v.exact == kDouble) return order(v.at.y, y);
  if (const int result = order_of_approximations(v.at.y, y); result != 0) return result;
  return compare_exactly(rationals_[v.exact].y, rationals_[v.exact].w, y);
}

}  // namespace weft::check

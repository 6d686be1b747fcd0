// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/spline.h"

#include <algorithm>
#include <array>

namespace weft::files {
namespace {

constexpr int kMaxDegree = 25;

// C. de Boor's algorithm, in homogeneous coordinates, between the knots `span` and span + 1. The
// tangent is the last line whose ends it divides.
CurvePoint point_of(const Spline& spline, std::size_t span, double t) {
  const auto degree = static_cast<std::size_t>(spline.degree);
  std::array<std::array<double, 3>, kMaxDegree + 1> d;
  for (std::size_t j = 0; j <= degree; ++j) {
    const std::size_t i = span - degree + j;
    const double w = spline.weights.empty() ? 1 : spline.weights[i];
    d[j] = {spline.control[i].x * w, spline.control[i].y * w, w};
  }
  const auto plane = [&d](std::size_t j) { return Point{d[j][0] / d[j][2], d[j][1] / d[j][2]}; };
  CurvePoint found;
  for (std::size_t r = 1; r <= degree; ++r) {
    if (r == degree) {
      const Point from = plane(degree - 1), to = plane(degree);
      found.tangent = {to.x - from.x, to.y - from.y};
    }
    for (std::size_t j = degree; j >= r; --j) {
      const double low = spline.knots[span - degree + j];
      const double share = (t - low) / (spline.knots[span + 1 + j - r] - low);
      for (std::size_t k = 0; k < 3; ++k) d[j][k] = (1 - share) * d[j - 1][k] + share * d[j][k];
    }
  }
  found.at = plane(degree);
  return found;
}

double extent_of(const std::vector<Point>& points) {
  const auto [west, east] = std::ranges::minmax_element(points, {}, &Point::x);
  const auto [south, north] = std::ranges::minmax_element(points, {}, &Point::y);
  return std::max(east->x - west->x, north->y - south->y);
}

}  // namespace

bool Spline::is_sound() const {
  return degree >= 1 && degree <= kMaxDegree && control.size() > static_cast<std::size_t>(degree) &&
         knots.size() == control.size() + static_cast<std::size_t>(degree) + 1 &&
         std::ranges::is_sorted(knots) &&
         knots[static_cast<std::size_t>(degree)] < knots[control.size()] &&
         (weights.empty() || weights.size() == control.size()) &&
         std::ranges::all_of(weights, [](double w) { return w > 0; });
}

ArcChain arcs_of(const Spline& spline) {
  const double extent = extent_of(spline.control);
  const int pieces = (spline.degree + 3) / 4;  // a polynomial of high degree may turn often
  ArcChain chain;
  for (auto span = static_cast<std::size_t>(spline.degree); span < spline.control.size(); ++span) {
    const double from = spline.knots[span];
    const double to = spline.knots[span + 1];
    if (!(from < to)) continue;
    const Curve curve = [&spline, span](double t) { return point_of(spline, span, t); };
    if (chain.points.empty()) chain = ArcChain({curve(from).at});
    add_biarcs(curve, from, to, pieces, extent, chain);
  }
  return chain;
}

}  // namespace weft::files

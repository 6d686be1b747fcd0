// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/dxf_curves.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace weft::files {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;

// Quarters of a circle that an arc has, up to four.
int pieces_of(double turn) {
  return static_cast<int>(std::clamp(std::ceil(turn / (kFullTurn / 4) - 1e-9), 1.0, 4.0));
}

std::array<double, 3> cross(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

std::array<double, 3> unit(std::array<double, 3> v) {
  const double length = std::hypot(v[0], v[1], v[2]);
  for (double& c : v) c /= length;
  return v;
}

}  // namespace

DxfPlacement DxfPlacement::after(const DxfPlacement& inner) const {
  const Point origin = (*this)({inner.x0, inner.y0});
  return {xx * inner.xx + xy * inner.yx,
          xx * inner.xy + xy * inner.yy,
          yx * inner.xx + yy * inner.yx,
          yx * inner.xy + yy * inner.yy,
          origin.x,
          origin.y};
}

bool DxfPlacement::keeps_circles() const {
  const double rounding = 1e-12 * std::hypot(std::hypot(xx, xy), std::hypot(yx, yy));
  const double sign = mirrors() ? -1 : 1;
  return std::abs(xx - sign * yy) <= rounding && std::abs(xy + sign * yx) <= rounding;
}

DxfPlacement plane_of(const std::array<double, 3>& extrusion, double height) {
  const double length = std::hypot(extrusion[0], extrusion[1], extrusion[2]);
  if (!(length > 0) || (extrusion[0] == 0 && extrusion[1] == 0 && extrusion[2] > 0)) return {};
  const std::array<double, 3> normal = unit(extrusion);
  const bool is_steep = std::abs(normal[0]) < 1.0 / 64 && std::abs(normal[1]) < 1.0 / 64;
  const std::array<double, 3> across =
      is_steep ? std::array<double, 3>{0, 1, 0} : std::array<double, 3>{0, 0, 1};
  const std::array<double, 3> x = unit(cross(across, normal));
  const std::array<double, 3> y = unit(cross(normal, x));
  return {x[0], y[0], x[1], y[1], normal[0] * height, normal[1] * height};
}

Point direction(double degrees) {
  int quarters = 0;
  const double rest = std::remquo(degrees, 90, &quarters) * (std::numbers::pi / 180);
  const double c = std::cos(rest);
  const double s = std::sin(rest);
  switch (quarters & 3) {
    case 0:
      return {c, s};
    case 1:
      return {-s, c};
    case 2:
      return {-c, -s};
    default:
      return {s, -c};
  }
}

void add_bulge(const DxfPlacement& place, Point a, Point b, double bulge, ArcChain& chain) {
  if (bulge == 0 || a == b || place.keeps_circles())
    return chain.add(place(b), place.mirrors() ? -bulge : bulge);
  const double turn = 4 * std::atan(bulge);
  const Point v{b.x - a.x, b.y - a.y};
  const auto turned = [&v](double scale, double angle) {
    const double x = scale * std::cos(angle), y = scale * std::sin(angle);
    return Point{x * v.x - y * v.y, x * v.y + y * v.x};
  };
  // Seen from a, a point of the arc lies half of the turn that is left to the right of b.
  const Curve curve = [&](double share) -> CurvePoint {
    const Point to =
        turned(std::sin(turn / 2 * share) / std::sin(turn / 2), turn / 2 * (share - 1));
    return {place({a.x + to.x, a.y + to.y}), place.linear(turned(1, turn * (share - 0.5)))};
  };
  const Point placed = place.linear(v);
  const double height = std::max(std::abs(bulge), 1.0);  // that of the arc, in chords
  add_biarcs(curve, 0, 1, pieces_of(std::abs(turn)), height * std::hypot(placed.x, placed.y),
             chain);
  chain.points.back() = place(b);
}

ArcChain arcs_of(const DxfEllipse& ellipse) {
  const auto [centre, major, minor, from, to] = ellipse;
  const Curve curve = [centre = centre, major = major, minor = minor](double t) -> CurvePoint {
    const double c = std::cos(t), s = std::sin(t);
    return {{centre.x + c * major.x + s * minor.x, centre.y + c * major.y + s * minor.y},
            {c * minor.x - s * major.x, c * minor.y - s * major.y}};
  };
  const double extent = 2 * std::max(std::hypot(major.x, minor.x), std::hypot(major.y, minor.y));
  ArcChain chain({curve(from).at});
  if (to > from) add_biarcs(curve, from, to, pieces_of(to - from), extent, chain);
  if (to - from > kFullTurn * (1 - 1e-10)) chain.points.back() = chain.points.front();
  return chain;
}

}  // namespace weft::files

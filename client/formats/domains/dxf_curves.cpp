// SPDX-License-Identifier: Apache-2.0
#include "client/formats/domains/dxf_curves.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace weft::client {
namespace {

constexpr double kMaxTurn = 2 * std::numbers::pi / 180;  // of a chord
constexpr int kMaxHalvings = 9;
constexpr int kMaxDegree = 25;

double turn(Point a, Point b, Point c) {
  const Point u{b.x - a.x, b.y - a.y};
  const Point v{c.x - b.x, c.y - b.y};
  return std::abs(std::atan2(u.x * v.y - u.y * v.x, u.x * v.x + u.y * v.y));
}

// One chord from `a` to `b` if the curve turns little between them, as three points say.
void halve(const DxfCurve& curve, double from, Point a, double to, Point b, int halvings,
           std::vector<Point>& points) {
  const double middle = from + (to - from) / 2;
  const Point m = curve(middle);
  const Point before = curve(from + (middle - from) / 2);
  const Point after = curve(middle + (to - middle) / 2);
  const double turned = turn(a, before, m) + turn(before, m, after) + turn(m, after, b);
  if (halvings == 0 || !(turned > 0.75 * kMaxTurn)) {
    points.push_back(b);
    return;
  }
  halve(curve, from, a, middle, m, halvings - 1, points);
  halve(curve, middle, m, to, b, halvings - 1, points);
}

// C. de Boor's algorithm, in homogeneous coordinates, between the knots `span` and span + 1.
Point point_of(const DxfSpline& spline, std::size_t span, double t) {
  const auto degree = static_cast<std::size_t>(spline.degree);
  std::array<std::array<double, 3>, kMaxDegree + 1> d;
  for (std::size_t j = 0; j <= degree; ++j) {
    const std::size_t i = span - degree + j;
    const double w = spline.weights.empty() ? 1 : spline.weights[i];
    d[j] = {spline.control[i].x * w, spline.control[i].y * w, w};
  }
  for (std::size_t r = 1; r <= degree; ++r)
    for (std::size_t j = degree; j >= r; --j) {
      const double low = spline.knots[span - degree + j];
      const double share = (t - low) / (spline.knots[span + 1 + j - r] - low);
      for (std::size_t k = 0; k < 3; ++k) d[j][k] = (1 - share) * d[j - 1][k] + share * d[j][k];
    }
  const auto& p = d[degree];
  return {p[0] / p[2], p[1] / p[2]};
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

void add_chords(const DxfCurve& curve, double from, double to, int pieces,
                std::vector<Point>& points) {
  double start = from;
  Point a = curve(from);
  for (int i = 1; i <= pieces; ++i) {
    const double end = i == pieces ? to : from + (to - from) * i / pieces;
    const Point b = curve(end);
    halve(curve, start, a, end, b, kMaxHalvings, points);
    start = end;
    a = b;
  }
}

void add_bulge_chords(Point a, Point b, double bulge, std::vector<Point>& points) {
  const double turn = 4 * std::atan(bulge);
  // Seen from a, a point of the arc lies half of the turn that is left to the right of b.
  const auto curve = [&](double share) {
    const double along = std::sin(turn / 2 * share) / std::sin(turn / 2);
    const double x = along * std::cos(turn / 2 * (1 - share));
    const double y = -along * std::sin(turn / 2 * (1 - share));
    return Point{a.x + x * (b.x - a.x) - y * (b.y - a.y), a.y + x * (b.y - a.y) + y * (b.x - a.x)};
  };
  if (std::abs(turn) > kMaxTurn && a != b) {
    add_chords(curve, 0, 1, 16, points);
    points.back() = b;
  } else {
    points.push_back(b);
  }
}

bool DxfSpline::is_sound() const {
  return degree >= 1 && degree <= kMaxDegree && control.size() > static_cast<std::size_t>(degree) &&
         knots.size() == control.size() + static_cast<std::size_t>(degree) + 1 &&
         std::ranges::is_sorted(knots) &&
         knots[static_cast<std::size_t>(degree)] < knots[control.size()] &&
         (weights.empty() || weights.size() == control.size()) &&
         std::ranges::all_of(weights, [](double w) { return w > 0; });
}

std::vector<Point> chords_of(const DxfSpline& spline) {
  std::vector<Point> points;
  for (auto span = static_cast<std::size_t>(spline.degree); span < spline.control.size(); ++span) {
    const double from = spline.knots[span];
    const double to = spline.knots[span + 1];
    if (!(from < to)) continue;
    const auto curve = [&spline, span](double t) { return point_of(spline, span, t); };
    if (points.empty()) points.push_back(curve(from));
    add_chords(curve, from, to, spline.degree == 1 ? 1 : 4, points);
  }
  return points;
}

Point DxfEllipse::operator()(double t) const {
  const double c = std::cos(t);
  const double s = std::sin(t);
  return {centre.x + c * major.x + s * minor.x, centre.y + c * major.y + s * minor.y};
}

}  // namespace weft::client

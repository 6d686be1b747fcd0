// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/arcs/arc_meeting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "engine/domain/triangulation/filtered.h"

namespace weft {
namespace {

constexpr double kSameDirection = 1e-4;  // radians

Vector scaled(Vector v, double by) {
  return {by * v.x, by * v.y};
}
Point moved(Point p, Vector by) {
  return {p.x + by.x, p.y + by.y};
}
Vector left_of(Vector v) {
  return {-v.y, v.x};
}

// The roots of a x^2 + 2 b x + c; if there is none, where it is least.
std::array<double, 2> roots(double a, double b, double c) {
  const double root = std::sqrt(std::max(0.0, b * b - a * c));
  const double sum = -(b + std::copysign(root, b));
  return {a != 0 ? sum / a : 0, sum != 0 ? c / sum : 0};
}

// The circle of a piece, or its line, as the zeros of `value`.
struct Circle {
  Point at;
  double curvature;
  Vector normal;  // left of the tangent

  double value(Point p) const {
    const Vector d = p - at;
    return curvature * dot(d, d) - 2 * dot(d, normal);
  }
  Vector gradient(Point p) const {
    const Vector d = p - at;
    return {2 * (curvature * d.x - normal.x), 2 * (curvature * d.y - normal.y)};
  }
};

Circle circle_of(const ArcPiece& p) {
  return {p.from, p.curvature, left_of(p.tangent)};
}

// The points of a line that are on a circle.
std::array<Point, 2> on_line(const Circle& circle, Point from, Vector direction) {
  const double a = circle.curvature * dot(direction, direction);
  const double b =
      circle.curvature * dot(from - circle.at, direction) - dot(direction, circle.normal);
  const auto [s, t] = roots(a, b, circle.value(from));
  return {moved(from, scaled(direction, s)), moved(from, scaled(direction, t))};
}

// A common point from one near to it: two of Newton's steps.
Point polished(const Circle& p, const Circle& q, Point at) {
  for (int step = 0; step < 2; ++step) {
    const Vector g = p.gradient(at), h = q.gradient(at);
    const double det = cross(g, h);
    if (std::fabs(det) < 1e-6 * length(g) * length(h)) return at;
    const double u = p.value(at), v = q.value(at);
    at = {at.x - (u * h.y - v * g.y) / det, at.y - (v * g.x - u * h.x) / det};
  }
  return at;
}

std::array<Point, 2> common_points(const ArcPiece& first, const ArcPiece& second) {
  const Circle p = circle_of(first), q = circle_of(second);
  if (second.bulge == 0) return on_line(p, second.from, second.to - second.from);
  if (first.bulge == 0) return on_line(q, first.from, first.to - first.from);
  // A sum of both equations without squares is that of a line.
  const Vector w = p.at - q.at;
  const Vector g{2 * (p.curvature * (q.normal.x - q.curvature * w.x) - q.curvature * p.normal.x),
                 2 * (p.curvature * (q.normal.y - q.curvature * w.y) - q.curvature * p.normal.y)};
  const double h = p.curvature * (2 * dot(w, q.normal) - q.curvature * dot(w, w));
  const double g2 = dot(g, g);
  if (g2 == 0) return {first.from, first.from};  // they have one centre
  return on_line(p, moved(p.at, scaled(g, -h / g2)), left_of(g));
}

// Whether q has an edge that no corner of p is left of; a corner on its line counts as left.
bool separates(const std::vector<Point>& q, const std::vector<Point>& p) {
  for (std::size_t i = 0; i < q.size(); ++i) {
    const Point a = q[i], b = q[(i + 1) % q.size()];
    if (std::all_of(p.begin(), p.end(), [&](Point c) { return orientation(a, b, c) < 0; }))
      return true;
  }
  return false;
}

bool boxes_meet(const std::vector<Point>& p, const std::vector<Point>& q) {
  Box a, b;
  for (const Point c : p) a.add(c);
  for (const Point c : q) b.add(c);
  return a.min_x <= b.max_x && b.min_x <= a.max_x && a.min_y <= b.max_y && b.min_y <= a.max_y;
}

// The corners of the hull that are seen from `apex`, a corner of it, farthest right and left.
std::array<Point, 2> cone(const std::vector<Point>& hull, Point apex) {
  std::array<Point, 2> sides{apex, apex};
  for (const Point c : hull) {
    if (c == apex) continue;
    if (sides[0] == apex || orientation(apex, sides[0], c) < 0) sides[0] = c;
    if (sides[1] == apex || orientation(apex, sides[1], c) > 0) sides[1] = c;
  }
  return sides;
}

bool in_cone(const std::array<Point, 2>& cone, Point apex, Point p) {
  const int right = orientation(apex, cone[0], p), left = orientation(apex, cone[1], p);
  if (right < 0 || left > 0) return false;
  return right > 0 || left < 0 || dot(cone[0] - apex, p - apex) > 0;
}

}  // namespace

ArcPiece::ArcPiece(std::uint32_t first, std::uint32_t last, Point start, Point end, double by)
    : a(first), b(last), from(start), to(end), bulge(by) {
  const double chord = length(to - from);
  curvature = curvature_of(chord, bulge);
  const Vector along = tangent_at_start(from, to, bulge);
  tangent = scaled(along, 1 / length(along));
  control = control_point(from, to, bulge);
}

std::vector<Point> ArcPiece::hull() const {
  const int side = bulge == 0 ? 0 : orientation(from, to, control);
  if (side == 0) return {from, to};
  if (side > 0) return {from, to, control};
  return {from, control, to};
}

double ArcPiece::height() const {
  return bulge == 0 ? 0 : std::fabs(cross(to - from, control - from)) / length(to - from);
}

bool ArcPiece::hull_is_near(Point p, double distance) const {
  const std::vector<Point> corners = hull();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector edge = corners[(i + 1) % corners.size()] - corners[i];
    if (cross(edge, p - corners[i]) < -distance * length(edge)) return false;
  }
  const Vector chord = to - from;
  const double along = dot(p - from, chord), margin = distance * length(chord);
  return along >= -margin && along <= dot(chord, chord) + margin;
}

bool ArcPiece::is_near(Point p, double distance) const {
  const Vector chord = to - from;
  const double along = dot(p - from, chord);
  const double above = std::copysign(1, -bulge) * cross(chord, p - from);  // the chord, as the arc
  const double margin =
      distance * length(chord);  // half a circle ends at right angles to its chord
  return along > -margin && along < dot(chord, chord) + margin && above > -margin &&
         above < dot(chord, chord) &&
         std::fabs(offset_from_circle(from, tangent, curvature, p)) < distance;
}

Vector ArcPiece::tangent_from(std::uint32_t vertex) const {
  if (vertex == a) return tangent;
  const Vector back = tangent_at_end(from, to, bulge);
  return scaled(back, -1 / length(back));
}

bool hulls_meet(const ArcPiece& p, const ArcPiece& q) {
  const std::vector<Point> a = p.hull(), b = q.hull();
  const bool at_start = p.a == q.a || p.a == q.b;
  if (!at_start && p.b != q.a && p.b != q.b)
    return boxes_meet(a, b) && !separates(a, b) && !separates(b, a);
  const Point apex = at_start ? p.from : p.to;
  const auto u = cone(a, apex), v = cone(b, apex);
  return in_cone(u, apex, v[0]) || in_cone(u, apex, v[1]) || in_cone(v, apex, u[0]) ||
         in_cone(v, apex, u[1]);
}

std::optional<Point> crossing_of(const ArcPiece& p, const ArcPiece& q, double margin) {
  const auto apart = [&](const ArcPiece& piece, Point at) {
    return std::min(length(at - piece.from), length(at - piece.to)) > 2 * margin;
  };
  std::optional<Point> nearest;
  for (const Point candidate : common_points(p, q)) {
    const Point at = polished(circle_of(p), circle_of(q), candidate);
    if (!(p.is_near(at, margin) && q.is_near(at, margin) && apart(p, at) && apart(q, at))) continue;
    if (!nearest || length(at - p.from) < length(*nearest - p.from)) nearest = at;
  }
  return nearest;
}

bool leave_together(const ArcPiece& p, const ArcPiece& q, std::uint32_t vertex) {
  const Vector u = p.tangent_from(vertex), v = q.tangent_from(vertex);
  return dot(u, v) > 0 && std::fabs(cross(u, v)) < kSameDirection;
}

}  // namespace weft

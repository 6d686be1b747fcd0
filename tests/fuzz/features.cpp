// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/features.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/domain/tolerance.h"

namespace weft::fuzz {
namespace {

struct Line {
  Point a, b;
};

double distance(Point p, Point q) {
  return std::hypot(q.x - p.x, q.y - p.y);
}

double distance(Point p, const Line& s) {
  const double x = s.b.x - s.a.x, y = s.b.y - s.a.y;
  const double length2 = x * x + y * y;
  if (length2 == 0) return distance(p, s.a);
  const double part = std::clamp(((p.x - s.a.x) * x + (p.y - s.a.y) * y) / length2, 0.0, 1.0);
  if (part > 0 && part < 1)
    return std::fabs((p.x - s.a.x) * y - (p.y - s.a.y) * x) / std::sqrt(length2);
  return std::min(distance(p, s.a), distance(p, s.b));
}

double sine(const Line& s, const Line& t) {
  const double ux = s.b.x - s.a.x, uy = s.b.y - s.a.y, vx = t.b.x - t.a.x, vy = t.b.y - t.a.y;
  return std::fabs(ux * vy - uy * vx) / (std::hypot(ux, uy) * std::hypot(vx, vy));
}

// Where the lines of two segments cross, if both segments come within `reach` of it.
std::optional<Point> crossing(const Line& s, const Line& t, double reach) {
  const double ux = s.b.x - s.a.x, uy = s.b.y - s.a.y, vx = t.b.x - t.a.x, vy = t.b.y - t.a.y;
  const double cross = ux * vy - uy * vx;
  if (cross == 0) return std::nullopt;
  const double part = ((t.a.x - s.a.x) * vy - (t.a.y - s.a.y) * vx) / cross;
  const Point p{s.a.x + part * ux, s.a.y + part * uy};
  if (!(distance(p, s) <= reach && distance(p, t) <= reach)) return std::nullopt;
  return p;
}

std::vector<Line> lines_of(const Pslg& pslg) {
  std::vector<Line> lines;
  for (const Segment& s : pslg.segments) lines.push_back({pslg.points[s.a], pslg.points[s.b]});
  return lines;
}

// Points of the input, and crossings.
std::vector<Point> vertices_of(const Pslg& pslg, const std::vector<Line>& lines, double tolerance) {
  std::vector<Point> vertices = pslg.points;
  for (std::size_t i = 0; i < lines.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (const auto p = crossing(lines[i], lines[j], 16 * tolerance)) vertices.push_back(*p);
  return vertices;
}

}  // namespace

bool is_contested(const MeshCase& mesh_case) {
  const Pslg& pslg = mesh_case.request.pslg;
  const double tolerance = merge_tolerance(pslg);
  const std::vector<Line> lines = lines_of(pslg);
  const std::vector<Point> vertices = vertices_of(pslg, lines, tolerance);
  const auto contested = [&](double d) { return d > tolerance / 16 && d < 16 * tolerance; };
  for (const Point p : vertices) {
    for (const Point q : vertices)
      if (contested(distance(p, q))) return true;
    for (const Line& s : lines)
      if (contested(distance(p, s))) return true;
  }
  return false;
}

bool is_too_fine(const MeshCase& mesh_case) {
  const Pslg& pslg = mesh_case.request.pslg;
  const double tolerance = merge_tolerance(pslg);
  const double floor = 4 * kEdgeFraction * largest_coordinate(pslg.points);
  const std::vector<Line> lines = lines_of(pslg);
  const std::vector<Point> vertices = vertices_of(pslg, lines, tolerance);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t j = 0; j < lines.size(); ++j) {
      if (i == j || !(sine(lines[i], lines[j]) < 0.1)) continue;
      for (const Point corner : vertices) {
        if (distance(corner, lines[i]) > 4 * tolerance ||
            distance(corner, lines[j]) > 4 * tolerance)
          continue;
        double finest = std::numeric_limits<double>::infinity();
        const auto see = [&](double d) {
          // What is nearer is merged, unless merging moves it apart.
          if (d > tolerance / 2) finest = std::min(finest, d);
        };
        for (const Point p : vertices) see(distance(p, corner));
        for (const Line& s : lines) see(distance(corner, s));
        // Merging may turn an arm by its reach over its length.
        const double turned =
            4 * tolerance /
            std::min(distance(lines[i].a, lines[i].b), distance(lines[j].a, lines[j].b));
        if (std::max(sine(lines[i], lines[j]) - turned, 0.0) * finest < floor) return true;
      }
    }
  }
  return false;
}

bool is_ambiguous(const FieldMesh& mesh) {
  // Of coordinates: a value of the nearest vertex may be 2^8 times another, and a millionth of it
  // is seen.
  const double rounding = 0x1p-53 * 0x1p30 * largest_coordinate(mesh.vertices);
  for (const auto& edges_of : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = edges_of[k], to = edges_of[(k + 1) % 3];
      const Line edge{mesh.vertices[from], mesh.vertices[to]};
      for (const auto& corners : mesh.triangles)
        for (const std::uint32_t v : corners)
          if (v != from && v != to && distance(mesh.vertices[v], edge) < rounding) return true;
    }
  }
  return false;
}

bool asks_for_nothing(const MeshCase& mesh_case) {
  const SizeSpec& size = mesh_case.request.size;
  const auto* const expression = std::get_if<std::string>(&size.value);
  const bool measures = std::any_of(
      size.fields.begin(), size.fields.end(),
      [](const FieldSpec& field) { return std::holds_alternative<DistanceSpec>(field.kind); });
  // The other expressions of mesh_case.cpp add a length, or are clamped above one.
  return measures && expression != nullptr && expression->find(" + ") == std::string::npos &&
         expression->find("clamp") == std::string::npos;
}

}  // namespace weft::fuzz

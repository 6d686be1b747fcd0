// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/dxf_shapes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "files/formats/domains/spline.h"

namespace weft::files {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;
constexpr double kDegree = std::numbers::pi / 180;

constexpr std::string_view kDrawn[] = {"3DFACE", "ARC",    "CIRCLE",     "ELLIPSE", "HATCH",
                                       "INSERT", "LINE",   "LWPOLYLINE", "POINT",   "POLYLINE",
                                       "SOLID",  "SPLINE", "TRACE"};
constexpr std::string_view kAnnotations[] = {
    "ACAD_TABLE",  "ARC_DIMENSION", "ATTDEF",
    "DIMENSION",   "IMAGE",         "LARGE_RADIAL_DIMENSION",
    "LEADER",      "LIGHT",         "MLEADER",
    "MTEXT",       "MULTILEADER",   "OLE2FRAME",
    "OLEFRAME",    "PDFUNDERLAY",   "DWFUNDERLAY",
    "DGNUNDERLAY", "RAY",           "RTEXT",
    "SHAPE",       "TABLE",         "TEXT",
    "TOLERANCE",   "VIEWPORT",      "WIPEOUT",
    "XLINE"};

// A line is closed whose ends are as near to each other as rounding brings them.
void close(ArcChain& line, bool is_closed) {
  std::vector<Point>& points = line.points;
  if (points.size() < 2) return;
  double extent = 0;
  for (const Point p : points)
    extent = std::max({extent, std::abs(p.x - points.front().x), std::abs(p.y - points.front().y)});
  const double gap = std::hypot(points.back().x - points.front().x,  //
                                points.back().y - points.front().y);
  if (gap <= 1e-9 * extent) {
    points.back() = points.front();
  } else if (is_closed) {
    points.push_back(points.front());
    line.bulges.push_back(0);  // keeps that of the segment which closes it
  }
}

DxfPlacement in_its_plane(const DxfEntity& entity, const DxfPlacement& placement, double height) {
  return placement.after(plane_of(entity.extrusion(), height));
}

DxfShape straight(const DxfEntity& entity, const DxfPlacement& placement) {
  return {.rings = {ArcChain({placement(entity.point(10)), placement(entity.point(11))})}};
}

DxfShape corners(const DxfEntity& entity, const DxfPlacement& placement) {
  const bool is_face = entity.kind == "3DFACE";
  const DxfPlacement place = is_face ? placement : in_its_plane(entity, placement, entity.real(30));
  std::vector<Point> ring = {place(entity.point(10)), place(entity.point(11)),
                             place(entity.point(12))};
  // The third and fourth corner of a solid are one opposite the other.
  if (entity.has(13)) ring.insert(ring.end() - (is_face ? 0 : 1), place(entity.point(13)));
  ring.push_back(ring.front());
  return {.kind = DxfShape::Kind::kArea, .rings = {ArcChain(std::move(ring))}};
}

DxfShape arc(const DxfEntity& entity, const DxfPlacement& placement) {
  const DxfPlacement place = in_its_plane(entity, placement, entity.real(30));
  const Point centre = entity.point(10);
  const double radius = entity.real(40);
  const double from = entity.kind == "CIRCLE" ? 0 : entity.real(50);
  const double to = entity.kind == "CIRCLE" ? 360 : entity.real(51);
  double turn = std::fmod(to - from, 360);
  if (turn < 0) turn += 360;
  const bool is_full = turn == 0 && from != to;
  if (is_full) turn = 360;
  if (!place.keeps_circles()) {
    const DxfEllipse curve{
        centre, {radius, 0}, {0, radius}, from * kDegree, (from + turn) * kDegree};
    return {.rings = {arcs_of(curve.placed(place))}, .has_computed_ends = true};
  }
  const auto at = [&](double degrees) {
    const Point u = direction(degrees);
    return place({centre.x + radius * u.x, centre.y + radius * u.y});
  };
  const int parts = turn > 180 ? 2 : 1;
  double bulge = turn / parts == 180 ? 1 : std::tan(turn / parts / 4 * kDegree);
  if (place.mirrors()) bulge = -bulge;
  ArcChain line({at(from)});
  if (parts == 2) line.add(at(from + turn / 2), bulge);
  line.add(is_full ? line.points.front() : at(to), bulge);
  return {.rings = {std::move(line)}, .has_computed_ends = true};
}

DxfShape ellipse(const DxfEntity& entity, const DxfPlacement& placement) {
  const auto m = entity.vector(11);
  const auto n = entity.extrusion();
  const double scale = entity.real(40, 1) / std::hypot(n[0], n[1], n[2]);
  DxfEllipse curve{entity.point(10),
                   {m[0], m[1]},
                   {(n[1] * m[2] - n[2] * m[1]) * scale, (n[2] * m[0] - n[0] * m[2]) * scale}};
  const double from = entity.real(41);
  const double to = entity.real(42, kFullTurn);
  double turn = std::fmod(to - from, kFullTurn);
  if (turn < 0) turn += kFullTurn;
  if (from != to && std::min(turn, kFullTurn - turn) < 1e-9) turn = kFullTurn;
  curve.from = from;
  curve.to = from + turn;
  return {.rings = {arcs_of(curve.placed(placement))}, .has_computed_ends = true};
}

std::optional<DxfShape> spline(const DxfEntity& entity, const DxfPlacement& placement) {
  Spline curve;
  curve.degree = entity.integer(71, 3);
  std::vector<Point> fit;
  for (const DxfGroup& group : entity.groups) {
    if (group.code == 40) curve.knots.push_back(entity.real_of(group));
    if (group.code == 41) curve.weights.push_back(entity.real_of(group));
    if (group.code == 10) curve.control.push_back({entity.real_of(group), 0});
    if (group.code == 11) fit.push_back({entity.real_of(group), 0});
    if (group.code == 20 && !curve.control.empty()) curve.control.back().y = entity.real_of(group);
    if (group.code == 21 && !fit.empty()) fit.back().y = entity.real_of(group);
  }
  const bool is_closed = (entity.integer(70) & 1) != 0;
  for (std::vector<Point>* points : {&curve.control, &fit})
    for (Point& p : *points) p = placement(p);
  DxfShape line{.has_computed_ends = true};
  if (curve.is_sound()) {
    line.rings.push_back(arcs_of(curve));
  } else if (fit.size() >= 2) {
    line.rings.emplace_back(std::move(fit));
  } else {
    return std::nullopt;
  }
  close(line.rings[0], is_closed);
  return line;
}

// Positions and their bulges; `flags` are those of LWPOLYLINE and POLYLINE.
DxfShape polyline(ArcChain line, int flags, const DxfPlacement& place) {
  close(line, (flags & 1) != 0);
  if (line.points.empty()) return {.rings = {std::move(line)}};
  ArcChain placed({place(line.points[0])});
  for (std::size_t i = 0; i + 1 < line.points.size(); ++i)
    add_bulge(place, line.points[i], line.points[i + 1], line.bulges[i], placed);
  return {.rings = {std::move(placed)}};
}

DxfShape light_polyline(const DxfEntity& entity, const DxfPlacement& placement) {
  ArcChain line;
  for (const DxfGroup& group : entity.groups) {
    if (group.code == 10) {
      line.points.push_back({entity.real_of(group), 0});
      line.bulges.push_back(0);
    }
    if (line.points.empty()) continue;
    if (group.code == 20) line.points.back().y = entity.real_of(group);
    if (group.code == 42) line.bulges.back() = entity.real_of(group);
  }
  return polyline(std::move(line), entity.integer(70),
                  in_its_plane(entity, placement, entity.real(38)));
}

std::optional<DxfShape> heavy_polyline(const DxfEntity& entity, const DxfPlacement& placement) {
  constexpr int kSpatial = 8, kMesh = 16 | 64, kFrame = 16;
  const int flags = entity.integer(70);
  if ((flags & kMesh) != 0) return std::nullopt;
  ArcChain line;
  for (const DxfRecord& vertex : entity.vertices) {
    if ((vertex.integer(70) & kFrame) != 0) continue;  // of a spline, which other vertices follow
    line.points.push_back(vertex.point(10));
    line.bulges.push_back(vertex.real(42));
  }
  return polyline(
      std::move(line), flags,
      (flags & kSpatial) != 0 ? placement : in_its_plane(entity, placement, entity.real(30)));
}

}  // namespace

bool is_drawn(std::string_view kind) {
  return std::ranges::find(kDrawn, kind) != std::end(kDrawn);
}

bool is_annotation(std::string_view kind) {
  return std::ranges::find(kAnnotations, kind) != std::end(kAnnotations);
}

std::optional<DxfShape> shape_of(const DxfEntity& entity, const DxfPlacement& placement) {
  const std::string_view kind = entity.kind;
  if (kind == "LINE") return straight(entity, placement);
  if (kind == "ARC" || kind == "CIRCLE") return arc(entity, placement);
  if (kind == "LWPOLYLINE") return light_polyline(entity, placement);
  if (kind == "POLYLINE") return heavy_polyline(entity, placement);
  if (kind == "ELLIPSE") return ellipse(entity, placement);
  if (kind == "SPLINE") return spline(entity, placement);
  if (kind == "POINT")
    return DxfShape{.kind = DxfShape::Kind::kPoint,
                    .rings = {ArcChain({placement(entity.point(10))})}};
  if (kind == "HATCH")
    return DxfShape{.kind = DxfShape::Kind::kArea,
                    .rings = hatch_rings(entity, in_its_plane(entity, placement, entity.real(30)))};
  return corners(entity, placement);
}

}  // namespace weft::files

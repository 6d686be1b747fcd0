// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/voronoi_cells.h"

#include <algorithm>
#include <cmath>
#include <utility>
namespace weft::files {
namespace {

// Distances below this count as 0, in lengths of a nearby edge.
constexpr double kTiny = 1e-9;

double cross(Point a, Point b, Point c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

double distance(Point a, Point b) {
  return std::hypot(b.x - a.x, b.y - a.y);
}

// The cotangent of the angle at c.
double cotangent(Point a, Point b, Point c) {
  return ((a.x - c.x) * (b.x - c.x) + (a.y - c.y) * (b.y - c.y)) / std::abs(cross(a, b, c));
}

}  // namespace

VoronoiCells::VoronoiCells(const MeshView& mesh)
    : mesh_(mesh),
      corner_(mesh.pages, mesh.triangles.size()),
      across_(opposite_sides(mesh, MeshEdges(mesh))),
      same_(mesh.pages, mesh.triangle_count()),
      beyond_(mesh.pages, mesh.triangle_count()),
      fan_(mesh.pages, mesh.vertex_count()),
      of_triangle_(mesh.pages, mesh.triangle_count()),
      of_side_(mesh.pages, mesh.triangles.size()),
      of_vertex_(mesh.pages, mesh.vertex_count()),
      of_middle_(mesh.pages, mesh.triangles.size()) {
  for (const std::size_t i : mesh.up_to(corner_.size())) corner_[i] = mesh.triangles[i];
  make_delaunay();
  merge_centres();
  for (const std::size_t t : mesh.up_to(beyond_.size()))
    beyond_[t] = way_out(static_cast<std::uint32_t>(t));
  find_fans();
  number_corners();
}

Point VoronoiCells::middle(std::uint32_t side) const {
  return {(from(side).x + to(side).x) / 2, (from(side).y + to(side).y) / 2};
}

double VoronoiCells::length(std::uint32_t side) const {
  return distance(from(side), to(side));
}

bool VoronoiCells::must_flip(std::uint32_t side) const {
  const Point a = from(side);
  const Point b = to(side);
  const Point c = from(previous(side));
  const Point d = from(previous(across_[side]));
  const double one = cotangent(a, b, c);
  const double two = cotangent(a, b, d);
  // Overlapping triangles, which weft never makes, could be flipped without end.
  const bool is_convex = cross(a, d, c) > 0 && cross(b, c, d) > 0;
  return is_convex && one + two < -kTiny * (1 + std::abs(one) + std::abs(two));
}

// Of the triangles a b c and b a d, the side a b becomes d c.
void VoronoiCells::flip(std::uint32_t side) {
  const std::uint32_t other = across_[side];
  const std::uint32_t c = corner_[previous(side)];
  const std::uint32_t d = corner_[previous(other)];
  const auto join = [this](std::uint32_t one, std::uint32_t two) {
    across_[one] = two;
    if (two != kNone) across_[two] = one;
  };
  const std::uint32_t a_d = across_[next(other)];
  const std::uint32_t b_c = across_[next(side)];
  // a d c, whose side c a stays, and b c d, whose side d b stays.
  corner_[next(side)] = d;
  corner_[next(other)] = c;
  join(side, a_d);
  join(other, b_c);
  join(next(side), next(other));
}

void VoronoiCells::make_delaunay() {
  std::vector<std::uint32_t> waiting;
  for (const std::size_t i : mesh_.up_to(across_.size())) {
    waiting.push_back(static_cast<std::uint32_t>(i));
    while (!waiting.empty()) {
      const std::uint32_t side = waiting.back();
      waiting.pop_back();
      if (on_boundary(side) || !must_flip(side)) continue;
      const std::uint32_t other = across_[side];
      flip(side);
      for (const std::uint32_t changed : {side, previous(side), other, previous(other)})
        waiting.push_back(changed);
    }
  }
}

Point VoronoiCells::circumcentre(std::uint32_t triangle) const {
  const Point a = point(corner_[3 * triangle]);
  const Point b = point(corner_[3 * triangle + 1]);
  const Point c = point(corner_[3 * triangle + 2]);
  const double bx = b.x - a.x;
  const double by = b.y - a.y;
  const double cx = c.x - a.x;
  const double cy = c.y - a.y;
  const double d = 2 * (bx * cy - by * cx);
  const double bb = bx * bx + by * by;
  const double cc = cx * cx + cy * cy;
  const Point centre = {a.x + (cy * bb - by * cc) / d, a.y + (bx * cc - cx * bb) / d};
  if (std::isfinite(centre.x) && std::isfinite(centre.y)) return centre;
  return {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3};  // of a triangle without area
}

std::uint32_t VoronoiCells::way_out(std::uint32_t triangle) const {
  const Point goal = circumcentre(triangle);
  const Point a = point(corner_[3 * triangle]);
  const Point b = point(corner_[3 * triangle + 1]);
  const Point c = point(corner_[3 * triangle + 2]);
  const Point start = {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3};
  const auto is_beyond = [&](std::uint32_t side) {
    const double size = length(side);
    return cross(from(side), to(side), goal) < -kTiny * size * size;
  };
  // The side through which the straight line leaves its triangle.
  std::uint32_t side = 3 * triangle;
  for (int k = 0; k < 3; ++k, side = next(side))
    if (cross(start, goal, from(side)) <= 0 && cross(start, goal, to(side)) >= 0) break;
  for (std::size_t steps = 0; steps < same_.size() && is_beyond(side); ++steps) {
    if (on_boundary(side)) return side;
    const std::uint32_t entry = across_[side];
    // The opposite corner decides between the two other sides.
    side = cross(start, goal, from(previous(entry))) >= 0 ? next(entry) : previous(entry);
  }
  return kNone;
}

void VoronoiCells::merge_centres() {
  for (const std::size_t t : mesh_.up_to(same_.size())) same_[t] = static_cast<std::uint32_t>(t);
  for (const std::size_t i : mesh_.up_to(across_.size())) {
    const auto side = static_cast<std::uint32_t>(i);
    if (on_boundary(side) || across_[side] < side) continue;
    if (distance(circumcentre(side / 3), circumcentre(across_[side] / 3)) > kTiny * length(side))
      continue;
    const auto [low, high] = std::minmax({of_centre(side / 3), of_centre(across_[side] / 3)});
    same_[high] = low;
  }
}

std::uint32_t VoronoiCells::of_centre(std::uint32_t triangle) const {
  while (same_[triangle] != triangle) triangle = same_[triangle];
  return triangle;
}

VoronoiCells::End VoronoiCells::near_end(std::uint32_t side) const {
  const std::uint32_t triangle = of_centre(side / 3);
  return {circumcentre(triangle), beyond_[triangle]};
}

VoronoiCells::End VoronoiCells::far_end(std::uint32_t side) const {
  if (!on_boundary(side)) return near_end(across_[side]);
  const End near = near_end(side);
  return near.beyond == side ? near : End{middle(side), kNone};
}

bool VoronoiCells::has_middle(std::uint32_t side) const {
  const End near = near_end(side);
  return near.beyond != side && distance(near.at, middle(side)) > kTiny * length(side);
}

bool VoronoiCells::crosses(std::uint32_t side) const {
  const End near = near_end(side);
  return near.beyond != kNone && near.beyond != far_end(side).beyond;
}

Point VoronoiCells::crossing(std::uint32_t side) const {
  const Point near = near_end(side).at;
  const Point far = far_end(side).at;
  const std::uint32_t wall = near_end(side).beyond;
  const double outside = cross(from(wall), to(wall), near);
  const double inside = cross(from(wall), to(wall), far);
  const double part = outside == inside ? 0 : std::clamp(outside / (outside - inside), 0.0, 1.0);
  return {near.x + part * (far.x - near.x), near.y + part * (far.y - near.y)};
}

void VoronoiCells::find_fans() {
  for (const std::size_t v : mesh_.up_to(fan_.size())) fan_[v] = kNone;
  for (const std::size_t i : mesh_.up_to(across_.size())) {
    const auto side = static_cast<std::uint32_t>(i);
    std::uint32_t& first = fan_[corner_[side]];
    cells_ += first == kNone ? 1 : 0;
    if (first != kNone && on_boundary(first) && on_boundary(side))
      more_fans_.emplace(corner_[side], side);
    else if (first == kNone || on_boundary(side))
      first = side;
  }
}

void VoronoiCells::number_corners() {
  std::uint32_t count = 0;
  for (const std::size_t i : mesh_.up_to(of_triangle_.size())) {
    const auto t = static_cast<std::uint32_t>(i);
    of_triangle_[t] = of_centre(t) == t && beyond_[t] == kNone ? count++ : kNone;
  }
  for (const std::size_t i : mesh_.up_to(of_side_.size())) {
    const auto side = static_cast<std::uint32_t>(i);
    of_side_[side] = crosses(side) ? count++ : kNone;
    of_middle_[side] = on_boundary(side) && has_middle(side) ? count++ : kNone;
  }
  for (const std::size_t v : mesh_.up_to(of_vertex_.size()))
    of_vertex_[v] = fan_[v] != kNone && on_boundary(fan_[v]) ? count++ : kNone;
  corners_ = count;
}

void VoronoiCells::each_corner(const std::function<void(Point)>& act) const {
  for (const std::size_t i : mesh_.up_to(of_triangle_.size()))
    if (of_triangle_[i] != kNone) act(circumcentre(static_cast<std::uint32_t>(i)));
  for (const std::size_t i : mesh_.up_to(of_side_.size())) {
    const auto side = static_cast<std::uint32_t>(i);
    if (of_side_[side] != kNone) act(crossing(side));
    if (of_middle_[side] != kNone) act(middle(side));
  }
  for (const std::size_t v : mesh_.up_to(of_vertex_.size()))
    if (of_vertex_[v] != kNone) act(point(static_cast<std::uint32_t>(v)));
}

// Counter-clockwise, beginning at the first triangle around a vertex.
void VoronoiCells::add_fan(std::uint32_t side, std::vector<std::uint32_t>& corners) const {
  const auto add = [&corners](std::uint32_t corner) {
    if (corner != kNone && (corners.empty() || corners.back() != corner)) corners.push_back(corner);
  };
  const std::uint32_t first = side;
  if (on_boundary(first)) {
    add(of_vertex_[corner_[first]]);
    add(of_middle_[first]);
    add(of_side_[first]);
  }
  for (;;) {
    add(of_triangle_[of_centre(side / 3)]);
    const std::uint32_t last = previous(side);
    add(of_side_[last]);
    if (on_boundary(last)) {
      add(of_middle_[last]);
      return;
    }
    side = across_[last];
    add(of_side_[side]);
    if (side == first) return;
  }
}

void VoronoiCells::each_cell(
    const std::function<void(std::uint32_t, std::span<const std::uint32_t>)>& act) const {
  std::vector<std::uint32_t> corners;
  for (const std::size_t i : mesh_.up_to(fan_.size())) {
    const auto v = static_cast<std::uint32_t>(i);
    if (fan_[v] == kNone) continue;
    corners.clear();
    add_fan(fan_[v], corners);
    const auto [more, end] = more_fans_.equal_range(v);
    for (auto fan = more; fan != end; ++fan) add_fan(fan->second, corners);
    if (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
    std::reverse(corners.begin(), corners.end());
    act(v, corners);
  }
}

}  // namespace weft::files

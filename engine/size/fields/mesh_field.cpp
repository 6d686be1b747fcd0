// SPDX-License-Identifier: Apache-2.0
#include "engine/size/fields/mesh_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/base/text.h"
#include "engine/size/fields/block_pyramid.h"
#include "engine/size/fields/polled_loop.h"
#include "engine/size/fields/radix_sort.h"

namespace weft {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kFlat = 0x1p-40;  // of the longest edge's square
constexpr double kLargest = 1e50;  // coordinate
constexpr std::size_t kMaxTriangles = std::size_t{1} << 30;
constexpr std::size_t kAtOnce = 1 << 14;

// Twice the area.
double doubled_area(Point a, Point b, Point c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

double longest2(Point a, Point b, Point c) {
  return std::max(distance2(a, b), std::max(distance2(b, c), distance2(c, a)));
}

Box box_of(Point a, Point b, Point c) {
  Box box;
  box.add(a);
  box.add(b);
  box.add(c);
  return box;
}

Box widened(const Box& box, double by) {
  return {box.min_x - by, box.min_y - by, box.max_x + by, box.max_y + by};
}

Interval known(const Interval& found) {
  return found.lo <= found.hi ? found : kUndefined;
}

class MeshSlope final : public Field {
 public:
  explicit MeshSlope(const MeshField& field) : field_(field) {}

  void evaluate(std::size_t n, const double* x, const double* y,
                double* out) const noexcept override {
    for (std::size_t i = 0; i < n; ++i) out[i] = field_.slope_at({x[i], y[i]});
  }
  Interval bounds(const Box& box) const noexcept override { return field_.slope_bounds(box); }
  std::size_t operations() const noexcept override { return field_.operations(); }

 private:
  const MeshField& field_;
};

}  // namespace

Result<MeshField> MeshField::make(FieldMesh mesh, const std::string& path,
                                  const ExecutionContext& context) {
  MeshField field(std::move(mesh));
  if (auto error = field.check(path, context)) return tl::unexpected(*error);
  if (auto error = field.build(path, context)) return tl::unexpected(*error);
  return field;
}

std::optional<Error> MeshField::check(const std::string& path,
                                      const ExecutionContext& context) const {
  constexpr std::size_t kPollInterval = 1 << 18;
  const std::size_t vertices = mesh_.vertices.size();
  const auto poll = [&](std::size_t i) {
    return i % kPollInterval == 0 ? context.poll() : std::nullopt;
  };
  if (mesh_.values.size() != vertices)
    return Error{ErrorCode::kBadOption, path + ".values",
                 path + ".values has " + std::to_string(mesh_.values.size()) + " values for " +
                     std::to_string(vertices) + " vertices; it must have one for each"};
  if (mesh_.triangles.size() > kMaxTriangles)
    return Error{ErrorCode::kBadOption, path + ".triangles",
                 path + ".triangles has " + std::to_string(mesh_.triangles.size()) +
                     " triangles, the limit is " + std::to_string(kMaxTriangles)};
  for (std::size_t i = 0; i < vertices; ++i) {
    if (auto error = poll(i)) return error;
    const Point p = mesh_.vertices[i];
    const bool x_is_bad = !(std::abs(p.x) <= kLargest);
    if (!x_is_bad && std::abs(p.y) <= kLargest) continue;
    const std::string field = path + ".vertices[" + std::to_string(i) + (x_is_bad ? "].x" : "].y");
    return Error{ErrorCode::kBadCoordinate, field,
                 field + " is " + text(x_is_bad ? p.x : p.y) +
                     "; coordinates must be finite and at most 1e50"};
  }
  for (std::size_t i = 0; i < vertices; ++i) {
    if (auto error = poll(i)) return error;
    if (!std::isinf(mesh_.values[i])) continue;
    const std::string field = path + ".values[" + std::to_string(i) + "]";
    return Error{
        ErrorCode::kBadSizeValue, field,
        field + " is " + text(mesh_.values[i]) + "; a value must be finite, or NaN for no data"};
  }
  for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
    if (auto error = poll(i)) return error;
    for (const std::uint32_t v : mesh_.triangles[i]) {
      if (v < vertices) continue;
      const std::string field = path + ".triangles[" + std::to_string(i) + "]";
      return Error{
          ErrorCode::kIndexOutOfRange, field,
          field + " names vertex " + std::to_string(v) + " of " + std::to_string(vertices)};
    }
  }
  return std::nullopt;
}

std::optional<Error> MeshField::build(const std::string& path, const ExecutionContext& context) {
  constexpr std::size_t kPollInterval = 1 << 18;
  if (auto error =
          context.need_bytes(bytes() + bytes_to_make(mesh_.triangles.size()), "a field of a mesh"))
    return error;
  std::vector<NumberedTriangle> triangles;
  triangles.reserve(mesh_.triangles.size());
  for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
    if (i % kPollInterval == 0) {
      if (auto error = context.poll()) return error;
    }
    auto [a, b, c] = mesh_.triangles[i];
    const Point p = mesh_.vertices[a];
    const Point q = mesh_.vertices[b];
    const Point r = mesh_.vertices[c];
    const double area = doubled_area(p, q, r);
    if (!(std::abs(area) > kFlat * longest2(p, q, r))) continue;
    if (area < 0) std::swap(b, c);
    triangles.push_back({{a, b, c}, static_cast<std::uint32_t>(i)});
  }
  if (triangles.empty())
    return Error{ErrorCode::kBadOption, path + ".triangles",
                 path + ".triangles has no triangle with an area"};
  mesh_.triangles = {};
  if (auto error = tree_.build(mesh_.vertices, std::move(triangles), context)) return error;
  if (auto error = cells_.build(tree_, context)) return error;
  const double extent = std::max(tree_.box().width(), tree_.box().height());
  within_ = widened(tree_.box(), 0x1p20 * extent);
  rounding_ = 0x1p-46 * extent;
  if (auto error = find_border(context)) return error;
  if (auto error = add_hulls(context)) return error;
  measure();
  return std::nullopt;
}

// An edge is inside if just two triangles have it, one in each direction, because all are
// counter-clockwise; all others are border edges.
std::optional<Error> MeshField::find_border(const ExecutionContext& context) {
  const auto& triangles = tree_.triangles();
  std::vector<Keyed> edges(3 * triangles.size());
  const auto ends = [&](std::uint32_t edge) {
    const auto& v = triangles[edge / 3].vertex;
    return std::pair{v[edge % 3], v[(edge % 3 + 1) % 3]};
  };
  const auto stop =
      polled_loop(context, (edges.size() + kAtOnce - 1) / kAtOnce, [&](std::size_t g) {
        const std::size_t end = std::min((g + 1) * kAtOnce, edges.size());
        for (std::size_t i = g * kAtOnce; i < end; ++i) {
          const auto edge = static_cast<std::uint32_t>(i);
          const auto [from, to] = ends(edge);
          edges[i] = {std::uint64_t{std::min(from, to)} << 32 | std::max(from, to), edge};
        }
      });
  if (stop) return stop;
  if (auto error = radix_sort(edges, context)) return error;
  border_.assign(triangles.size(), 0);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].key == edges[i].key) ++end;
    const bool inside = end - i == 2 && ends(edges[i].item).first == ends(edges[i + 1].item).second;
    for (; i < end; ++i) {
      if (!inside) border_[edges[i].item / 3] |= static_cast<std::uint8_t>(1u << edges[i].item % 3);
    }
  }
  return std::nullopt;
}

std::optional<Error> MeshField::add_hulls(const ExecutionContext& context) {
  for (std::size_t level = 0; level < tree_.levels(); ++level) {
    std::vector<Hull> made(tree_.items(level), Hull{kNoValue, kNoValue, false});
    const std::size_t children = level == 0 ? tree_.triangles().size() : hulls_.back().size();
    const auto stop =
        polled_loop(context, (made.size() + kAtOnce - 1) / kAtOnce, [&](std::size_t group) {
          const std::size_t end = std::min((group + 1) * kAtOnce, made.size());
          for (std::size_t i = group * kAtOnce; i < end; ++i) {
            const std::size_t last =
                std::min(i * TriangleTree::kFan + TriangleTree::kFan, children);
            for (std::size_t k = i * TriangleTree::kFan; k < last; ++k) {
              const Hull child =
                  level == 0 ? hull_of(static_cast<std::uint32_t>(k)) : hulls_.back()[k];
              add(made[i].value, child.value);
              add(made[i].slope, child.slope);
              made[i].at_border |= child.at_border;
            }
          }
        });
    if (stop) return stop;
    hulls_.push_back(std::move(made));
  }
  return std::nullopt;
}

// The mean over centroids along the tree's curve, and points in and around the box of the mesh.
void MeshField::measure() {
  constexpr std::size_t kAlong = 256;
  constexpr std::size_t kEachWay = 12;
  constexpr std::size_t kPerVisit = 4;
  std::size_t visits = 0;
  const std::size_t places = tree_.triangles().size();
  const std::size_t along = std::min(kAlong, places);
  for (std::size_t i = 0; i < along; ++i) {
    const auto place = static_cast<std::uint32_t>(i * places / along);
    visits += find(centroid(tree_.corner(place, 0), tree_.corner(place, 1), tree_.corner(place, 2)))
                  .visits;
  }
  const Box& box = tree_.box();
  const auto spread = [](std::size_t i) {
    return 1.2 * (static_cast<double>(i) + 0.5) / kEachWay - 0.1;
  };
  for (std::size_t i = 0; i < kEachWay; ++i) {
    for (std::size_t j = 0; j < kEachWay; ++j)
      visits +=
          find({box.min_x + box.width() * spread(i), box.min_y + box.height() * spread(j)}).visits;
  }
  operations_ = kLanes * (10 + kPerVisit * visits / (along + kEachWay * kEachWay));
}

Point MeshField::brought_near(Point p) const noexcept {
  return {std::clamp(p.x, within_.min_x, within_.max_x),
          std::clamp(p.y, within_.min_y, within_.max_y)};
}

TriangleTree::Found MeshField::find(Point p) const noexcept {
  TriangleTree::Found found;
  if (const auto near = cells_.near(p)) {
    for (const std::uint32_t place : *near) {
      ++found.visits;
      if (tree_.holds(place, p)) return {place, 0, p, found.visits};
    }
  } else {
    found = tree_.holding(p);
    if (found.place != kNone) return found;
  }
  const std::size_t visits = found.visits;
  found = tree_.nearest(p);
  found.visits += visits;
  return found;
}

// With weights from 0 to 1, so that nothing overflows.
double MeshField::value_in(std::uint32_t place, Point p) const noexcept {
  const Point a = tree_.corner(place, 0);
  const Point b = tree_.corner(place, 1);
  const Point c = tree_.corner(place, 2);
  const double area = doubled_area(a, b, c);
  const double to_b = std::clamp(doubled_area(a, p, c) / area, 0.0, 1.0);
  const double to_c = std::clamp(doubled_area(a, b, p) / area, 0.0, 1.0 - to_b);
  const double at_a = vertex_value(place, 0);
  const double at_b = vertex_value(place, 1);
  const double at_c = vertex_value(place, 2);
  // Keeps the result within the range of the three. A NaN passes through.
  return std::clamp((1 - to_b - to_c) * at_a + to_b * at_b + to_c * at_c,
                    std::min(std::min(at_a, at_b), at_c), std::max(std::max(at_a, at_b), at_c));
}

Point MeshField::gradient_of(std::uint32_t place) const noexcept {
  const Point a = tree_.corner(place, 0);
  const Point b = tree_.corner(place, 1);
  const Point c = tree_.corner(place, 2);
  const double area = doubled_area(a, b, c);
  const double to_b = vertex_value(place, 1) - vertex_value(place, 0);
  const double to_c = vertex_value(place, 2) - vertex_value(place, 0);
  return {(to_b * (c.y - a.y) - to_c * (b.y - a.y)) / area,
          (to_c * (b.x - a.x) - to_b * (c.x - a.x)) / area};
}

double MeshField::slope_of(std::uint32_t place) const noexcept {
  const Point g = gradient_of(place);
  return std::sqrt(g.x * g.x + g.y * g.y);
}

double MeshField::value_at(Point p) const noexcept {
  const TriangleTree::Found found = find(brought_near(p));
  return found.place == kNone ? kNan : value_in(found.place, found.point);
}

void MeshField::evaluate(std::size_t n, const double* x, const double* y,
                         double* out) const noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    // Batches are filled up with copies of a point.
    const bool again = i > 0 && x[i] == x[i - 1] && y[i] == y[i - 1];
    out[i] = again ? out[i - 1] : value_at({x[i], y[i]});
  }
}

double MeshField::slope_at(Point p) const noexcept {
  const TriangleTree::Found found = find(brought_near(p));
  return found.place == kNone ? kNan : slope_of(found.place);
}

auto MeshField::hull_of(std::uint32_t place) const noexcept -> Hull {
  Hull hull{kNoValue, kNoValue, border_[place] != 0};
  for (int k = 0; k < 3; ++k) {
    if (std::isnan(vertex_value(place, k))) {
      hull.value = kNoValue;
      hull.value.may_be_nan = hull.slope.may_be_nan = true;
      return hull;
    }
    add(hull.value, vertex_value(place, k));
  }
  const double slope = slope_of(place);
  add(hull.slope, slope);
  hull.slope.may_be_nan = std::isnan(slope);  // if values are near the largest double
  return hull;
}

// Linear, so between its extremes at the corners of the box.
auto MeshField::hull_in(std::uint32_t place, const Box& box) const noexcept -> Hull {
  Hull hull = hull_of(place);
  const Point a = tree_.corner(place, 0);
  const Point b = tree_.corner(place, 1);
  const Point c = tree_.corner(place, 2);
  const double half_width = 0.5 * box.width();
  const double half_height = 0.5 * box.height();
  const Point middle{box.min_x + half_width, box.min_y + half_height};
  const double length2 = longest2(a, b, c);
  const double reach2 = std::max(length2, distance2(middle, a));
  // Rounding of `side` at points of the box.
  const double blur = 0x1p-44 * (reach2 + half_width * half_width + half_height * half_height);
  const std::array<Point, 3> corners{a, b, c};
  bool at_border = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const Point from = corners[k];
    const Point to = corners[(k + 1) % 3];
    const double at_middle = doubled_area(from, to, middle);
    const double across =
        std::abs(to.y - from.y) * half_width + std::abs(to.x - from.x) * half_height + blur;
    if (at_middle < -across) return {kNoValue, kNoValue, false};  // beyond this edge
    if ((border_[place] >> k & 1) != 0 && at_middle <= across && meet(box_of(from, to, to), box))
      at_border = true;
  }
  hull.at_border = at_border;
  if (!(hull.value.lo < hull.value.hi)) return hull;

  const Point g = gradient_of(place);
  const double most = std::max(-hull.value.lo, hull.value.hi);
  const double at_middle =
      vertex_value(place, 0) + (g.x * (middle.x - a.x) + g.y * (middle.y - a.y));
  const double steep = std::abs(g.x) + std::abs(g.y);
  const double change = std::abs(g.x) * half_width + std::abs(g.y) * half_height +
                        0x1p-44 * (most + steep * std::sqrt(reach2)) +
                        0x1p-44 * (length2 / doubled_area(a, b, c)) *
                            (steep * std::sqrt(reach2) + (hull.value.hi - hull.value.lo));
  const double lo = at_middle - change;
  const double hi = at_middle + change;
  if (lo <= hull.value.hi && hi >= hull.value.lo) {
    hull.value.lo = std::max(hull.value.lo, lo);
    hull.value.hi = std::min(hull.value.hi, hi);
  }
  return hull;
}

auto MeshField::hull_over(const Box& box) const noexcept -> Hull {
  Hull all{kNoValue, kNoValue, false};
  const auto take = [&](const Hull& hull) {
    add(all.value, hull.value);
    add(all.slope, hull.slope);
    all.at_border |= hull.at_border;
  };
  tree_.cover(
      box, [&](std::size_t level, std::size_t i) { take(hulls_[level][i]); },
      [&](std::uint32_t place) {
        if (meet(box_of(tree_.corner(place, 0), tree_.corner(place, 1), tree_.corner(place, 2)),
                 box))
          take(hull_in(place, box));
      });
  return all;
}

// How many triangles hold a point changes only at border edges. So in a box that meets none, the
// middle decides for all points: if one triangle holds the middle, each point is in exactly one
// triangle, or so near to one that `rounding_` covers it. In any other box, a point is at most half
// a diagonal farther from a triangle than the middle is.
auto MeshField::look(const Box& box) const noexcept -> Look {
  const Point from = brought_near({box.min_x, box.min_y});
  const Point to = brought_near({box.max_x, box.max_y});
  const Box near{from.x, from.y, to.x, to.y};
  const Point middle{0.5 * (from.x + to.x), 0.5 * (from.y + to.y)};
  const Hull hull = hull_over(widened(near, rounding_));
  const TriangleTree::Found found = find(middle);
  if (found.place == kNone) return {{kNoValue, kNoValue, true}, false};  // a NaN
  if (!hull.at_border && tree_.count_holding(middle) > 0) {
    const auto beside = [&](double x, double y) {
      return Point{middle.x + x * near.width(), middle.y + y * near.height()};
    };
    // The middle may be on an edge.
    bool one_layer = false;
    for (const Point p : {middle, beside(0.17, 0.11), beside(-0.13, 0.19), beside(0.07, -0.23)})
      one_layer = one_layer || tree_.count_holding(p) == 1;
    return {hull, one_layer};
  }
  const double reach =
      (std::sqrt(found.distance2) + 0.5 * std::sqrt(distance2(from, to))) * (1 + 0x1p-40) +
      rounding_;
  return {hull_over(widened(near, reach)), false};
}

Interval MeshField::bounds(const Box& box) const noexcept {
  return known(look(box).hull.value);
}

Interval MeshField::slope_bounds(const Box& box) const noexcept {
  return known(look(box).hull.slope);
}

double MeshField::steepness(const Box& box) const noexcept {
  const Look seen = look(box);
  if (!seen.one_layer || seen.hull.at_border) return kInfinity;
  return std::max(0.0, seen.hull.slope.hi);
}

std::unique_ptr<const Field> MeshField::slope() const {
  return std::make_unique<MeshSlope>(*this);
}

std::size_t MeshField::bytes() const noexcept {
  std::size_t bytes = mesh_.vertices.capacity() * sizeof(Point) +
                      mesh_.triangles.capacity() * sizeof(mesh_.triangles[0]) +
                      mesh_.values.capacity() * sizeof(double) + tree_.bytes() + cells_.bytes() +
                      border_.capacity();
  for (const auto& level : hulls_) bytes += level.capacity() * sizeof(Hull);
  return bytes;
}

}  // namespace weft

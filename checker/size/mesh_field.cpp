// SPDX-License-Identifier: Apache-2.0
#include "checker/size/mesh_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "checker/geometry/sum.h"
#include "checker/size/segment_distance.h"
#include "checker/text.h"

namespace weft::check {
namespace {

bool is_flat(const std::array<Vec2, 3>& p) {
  long double longest = 0;  // squared
  for (std::size_t i = 0; i < 3; ++i) {
    const long double dx = static_cast<long double>(p[(i + 1) % 3].x) - p[i].x;
    const long double dy = static_cast<long double>(p[(i + 1) % 3].y) - p[i].y;
    longest = std::max(longest, dx * dx + dy * dy);
  }
  return std::fabs(cross_from(p[0], p[1], p[2])) <= 2 * 0x1p-40L * longest;
}

}  // namespace

tl::expected<MeshValues, std::string> MeshValues::make(const MeshField& field) {
  if (field.values.size() != field.vertices.size())
    return tl::unexpected(
        say(field.values.size(), " values at ", field.vertices.size(), " vertices"));
  for (std::size_t v = 0; v < field.vertices.size(); ++v)
    if (!std::isfinite(field.vertices[v].x) || !std::isfinite(field.vertices[v].y))
      return tl::unexpected(say("vertex ", v, " is ", field.vertices[v]));
  std::vector<std::uint32_t> used;
  std::vector<Box> boxes;
  for (std::uint32_t t = 0; t < field.triangles.size(); ++t) {
    std::array<Vec2, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t v = field.triangles[t][i];
      if (v >= field.vertices.size())
        return tl::unexpected(
            say("triangle ", t, " has vertex ", v, " of ", field.vertices.size()));
      corners[i] = field.vertices[v];
    }
    if (is_flat(corners)) continue;
    Box box = box_of(corners[0], corners[1]);
    box.add(box_of(corners[2], corners[2]));
    used.push_back(t);
    boxes.push_back(box);
  }
  if (used.empty()) return tl::unexpected(std::string("no triangle has an area"));
  return MeshValues(field, std::move(used), std::move(boxes));
}

std::array<Vec2, 3> MeshValues::corners(std::uint32_t triangle) const {
  const auto [a, b, c] = field_->triangles[triangle];
  return {field_->vertices[a], field_->vertices[b], field_->vertices[c]};
}

auto MeshValues::nearest_in(const std::array<Vec2, 3>& corners, Vec2 p) -> Place {
  const long double whole = cross_from(corners[0], corners[1], corners[2]);
  Place place;
  bool inside = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const long double share = cross_from(p, corners[(i + 1) % 3], corners[(i + 2) % 3]) / whole;
    inside = inside && share >= 0;
    place.weights[i] = static_cast<double>(share);
  }
  if (inside) return place;
  place.distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    const NearestOnSegment on = nearest_on_segment(corners[i], corners[next], p);
    if (on.distance >= place.distance) continue;
    place = {on.distance, {}};
    place.weights[i] = 1 - on.t;
    place.weights[next] = on.t;
  }
  return place;
}

std::uint32_t MeshValues::nearest(Vec2 p) const {
  std::uint32_t first = std::numeric_limits<std::uint32_t>::max();
  tree_.visit(box_of(p, p), [&](std::uint32_t i) {
    if (i < first && nearest_in(corners(used_[i]), p).distance == 0) first = i;
  });
  if (first < used_.size()) return used_[first];
  double least = std::numeric_limits<double>::infinity();
  const std::optional<std::uint32_t> found = tree_.least(
      p, 1, least, [&](std::uint32_t i) { return nearest_in(corners(used_[i]), p).distance; });
  return used_[found.value_or(0)];
}

double MeshValues::value(Vec2 p) const {
  const std::uint32_t t = nearest(p);
  const Place place = nearest_in(corners(t), p);
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i)
    sum += place.weights[i] * field_->values[field_->triangles[t][i]];
  return sum;
}

double MeshValues::slope(Vec2 p) const {
  const std::uint32_t t = nearest(p);
  const auto [a, b, c] = corners(t);
  const auto [at_a, at_b, at_c] = field_->triangles[t];
  const long double db = static_cast<long double>(field_->values[at_b]) - field_->values[at_a];
  const long double dc = static_cast<long double>(field_->values[at_c]) - field_->values[at_a];
  const long double whole = cross_from(a, b, c);
  const long double bx = static_cast<long double>(b.x) - a.x;
  const long double by = static_cast<long double>(b.y) - a.y;
  const long double cx = static_cast<long double>(c.x) - a.x;
  const long double cy = static_cast<long double>(c.y) - a.y;
  return static_cast<double>(std::hypot((db * cy - dc * by) / whole, (dc * bx - db * cx) / whole));
}

}  // namespace weft::check

// SPDX-License-Identifier: Apache-2.0
#include "engine/size/fields/triangle_tree.h"

#include <functional>
#include <utility>

#include "engine/size/fields/polled_loop.h"
#include "engine/size/fields/radix_sort.h"

namespace weft {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kAtOnce = 1 << 14;

// Along the Hilbert curve of 2^32 cells each way.
std::uint64_t hilbert_key(std::uint32_t x, std::uint32_t y) {
  std::uint64_t key = 0;
  for (std::uint32_t bit = 1u << 31; bit > 0; bit >>= 1) {
    const std::uint32_t right = (x & bit) != 0;
    const std::uint32_t upper = (y & bit) != 0;
    key = 4 * key + ((3 * right) ^ upper);
    if (upper == 0) {
      if (right == 1) {
        x = ~x;
        y = ~y;
      }
      std::swap(x, y);
    }
  }
  return key;
}

double axis_distance(double value, double lo, double hi) {
  return value < lo ? lo - value : value > hi ? value - hi : 0.0;
}

}  // namespace

std::optional<Error> TriangleTree::build(const std::vector<Point>& vertices,
                                         std::vector<NumberedTriangle> triangles,
                                         const ExecutionContext& context) {
  vertices_ = vertices.data();
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (const std::uint32_t v : triangles[i].vertex) box_.add(vertices[v]);
    if (i % kAtOnce == 0) {
      if (auto error = context.poll()) return error;
    }
  }
  // A mesh has an area, so its box has one; so the scale is finite, unless the mesh is tiny.
  const double side = std::max(box_.width(), box_.height());
  std::vector<Keyed> order(triangles.size());
  const std::size_t groups = (order.size() + kAtOnce - 1) / kAtOnce;
  auto stop = polled_loop(context, groups, [&](std::size_t group) {
    const std::size_t end = std::min((group + 1) * kAtOnce, order.size());
    for (std::size_t i = group * kAtOnce; i < end; ++i) {
      const auto& v = triangles[i].vertex;
      const Point c = centroid(vertices[v[0]], vertices[v[1]], vertices[v[2]]);
      const auto cell = [side](double from_least) {
        return static_cast<std::uint32_t>(std::clamp(from_least / side, 0.0, 1.0) * 4294967295.0);
      };
      order[i] = {hilbert_key(cell(c.x - box_.min_x), cell(c.y - box_.min_y)),
                  static_cast<std::uint32_t>(i)};
    }
  });
  if (stop) return stop;
  if (auto error = radix_sort(order, context)) return error;
  triangles_.resize(triangles.size());
  stop = polled_loop(context, groups, [&](std::size_t group) {
    const std::size_t end = std::min((group + 1) * kAtOnce, order.size());
    for (std::size_t i = group * kAtOnce; i < end; ++i) triangles_[i] = triangles[order[i].item];
  });
  if (stop) return stop;
  return add_levels(context);
}

std::optional<Error> TriangleTree::add_levels(const ExecutionContext& context) {
  for (std::size_t items = (triangles_.size() + kFan - 1) / kFan; items > 1 || quads_.empty();
       items = (items + kFan - 1) / kFan) {
    const std::size_t level = quads_.size();
    std::vector<Quad> made((items + kFan - 1) / kFan);
    // The box of item i of this level, and the least number of a triangle in it.
    const auto extent = [&](std::size_t i) {
      std::pair<Box, std::uint32_t> all{Box{}, kNone};
      if (level == 0) {
        const std::size_t end = std::min<std::size_t>(i * kFan + kFan, triangles_.size());
        for (std::size_t place = i * kFan; place < end; ++place) {
          for (const std::uint32_t v : triangles_[place].vertex) all.first.add(vertices_[v]);
          all.second = std::min(all.second, triangles_[place].number);
        }
      } else if (i < items) {
        const Quad& quad = quads_[level - 1][i];
        for (std::size_t k = 0; k < kFan; ++k) {
          all.first.merge({quad.min_x[k], quad.min_y[k], quad.max_x[k], quad.max_y[k]});
          all.second = std::min(all.second, quad.first[k]);
        }
      }
      return all;
    };
    const auto stop =
        polled_loop(context, (made.size() + kAtOnce - 1) / kAtOnce, [&](std::size_t group) {
          const std::size_t end = std::min((group + 1) * kAtOnce, made.size());
          for (std::size_t i = group * kAtOnce; i < end; ++i) {
            for (std::size_t k = 0; k < kFan; ++k) {
              const auto [box, first] = extent(i * kFan + k);
              made[i].min_x[k] = box.min_x;
              made[i].min_y[k] = box.min_y;
              made[i].max_x[k] = box.max_x;
              made[i].max_y[k] = box.max_y;
              made[i].first[k] = first;
            }
          }
        });
    if (stop) return stop;
    quads_.push_back(std::move(made));
  }
  return std::nullopt;
}

std::size_t TriangleTree::bytes() const noexcept {
  std::size_t bytes = triangles_.capacity() * sizeof(NumberedTriangle);
  for (const auto& level : quads_) bytes += level.capacity() * sizeof(Quad);
  return bytes;
}

// Calls take(place) for triangles that hold p and whose number is below `below`, which `take` may
// lower. Returns what Found::visits means.
template <class Take>
std::size_t TriangleTree::visit_holding(Point p, const std::uint32_t& below,
                                        const Take& take) const noexcept {
  std::size_t visits = 0;
  Stack stack;
  stack.push(root());
  while (stack.size > 0) {
    const Item item = stack.pop();
    visits += kFan;
    if (item.level == 0) {
      const std::size_t end = std::min<std::size_t>(item.index * kFan + kFan, triangles_.size());
      for (std::size_t place = item.index * kFan; place < end; ++place)
        if (triangles_[place].number < below && holds(static_cast<std::uint32_t>(place), p))
          take(static_cast<std::uint32_t>(place));
      continue;
    }
    const Quad& quad = quads_[item.level - 1][item.index];
    for (std::uint32_t k = kFan; k-- > 0;) {
      if (quad.min_x[k] <= p.x && p.x <= quad.max_x[k] && quad.min_y[k] <= p.y &&
          p.y <= quad.max_y[k] && quad.first[k] < below)
        stack.push({item.level - 1, item.index * kFan + k});
    }
  }
  return visits;
}

TriangleTree::Found TriangleTree::holding(Point p) const noexcept {
  Found found;
  std::uint32_t below = kNone;
  found.visits = visit_holding(p, below, [&](std::uint32_t place) {
    found.place = place;
    below = triangles_[place].number;
  });
  if (found.place != kNone) {
    found.distance2 = 0;
    found.point = p;
  }
  return found;
}

int TriangleTree::count_holding(Point p) const noexcept {
  int count = 0;
  std::uint32_t below = kNone;
  visit_holding(p, below, [&](std::uint32_t) {
    if (++count == 2) below = 0;
  });
  return count;
}

// A point of an edge never leaves the edge's box, so the distance is never below that of a box.
void TriangleTree::take_if_nearer(std::uint32_t place, Point p, Found& best) const noexcept {
  for (int k = 0; k < 3; ++k) {
    std::uint32_t from = triangles_[place].vertex[static_cast<std::size_t>(k)];
    std::uint32_t to = triangles_[place].vertex[static_cast<std::size_t>((k + 1) % 3)];
    if (from > to) std::swap(from, to);  // the same point for both triangles of an edge
    const Point a = vertices_[from];
    const Point b = vertices_[to];
    const Point along{b.x - a.x, b.y - a.y};
    const double length2 = along.x * along.x + along.y * along.y;
    const double t =
        std::clamp(((p.x - a.x) * along.x + (p.y - a.y) * along.y) / length2, 0.0, 1.0);
    const Point q =
        t == 1 ? b
               : Point{std::clamp(a.x + t * along.x, std::min(a.x, b.x), std::max(a.x, b.x)),
                       std::clamp(a.y + t * along.y, std::min(a.y, b.y), std::max(a.y, b.y))};
    const double d2 = distance2(p, q);
    if (d2 < best.distance2 || (d2 == best.distance2 && best.place != kNone &&
                                triangles_[place].number < triangles_[best.place].number)) {
      best.place = place;
      best.distance2 = d2;
      best.point = q;
    }
  }
}

TriangleTree::Found TriangleTree::nearest(Point p) const noexcept {
  Found best;
  Stack stack;
  std::array<double, kMaxLevels * kFan> distances;
  distances[0] = 0;
  stack.push(root());
  while (stack.size > 0) {
    const Item item = stack.pop();
    if (distances[stack.size] > best.distance2) continue;
    best.visits += kFan;
    if (item.level == 0) {
      const std::size_t end = std::min<std::size_t>(item.index * kFan + kFan, triangles_.size());
      for (std::size_t place = item.index * kFan; place < end; ++place)
        take_if_nearer(static_cast<std::uint32_t>(place), p, best);
      continue;
    }
    // The nearest child is pushed last.
    const Quad& quad = quads_[item.level - 1][item.index];
    std::array<std::pair<double, std::uint32_t>, kFan> children;
    std::size_t count = 0;
    for (std::uint32_t k = 0; k < kFan; ++k) {
      const double x = axis_distance(p.x, quad.min_x[k], quad.max_x[k]);
      const double y = axis_distance(p.y, quad.min_y[k], quad.max_y[k]);
      const double d2 = x * x + y * y;
      if (d2 <= best.distance2 && d2 < kInfinity) children[count++] = {d2, k};
    }
    std::sort(children.begin(), children.begin() + static_cast<std::ptrdiff_t>(count),
              std::greater<>());
    for (std::size_t n = 0; n < count; ++n) {
      distances[stack.size] = children[n].first;
      stack.push({item.level - 1, item.index * kFan + children[n].second});
    }
  }
  return best;
}

}  // namespace weft

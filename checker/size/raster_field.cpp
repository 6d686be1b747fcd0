// SPDX-License-Identifier: Apache-2.0
#include "checker/size/raster_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "checker/text.h"

namespace weft::check {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kBeside = 0.5 + 1e-6;  // in cells

struct Place {
  std::size_t node;  // the lower of two nodes
  std::size_t next;
  double t;  // from 0 at this node to 1 at the next
};

std::optional<Place> place(double steps, std::size_t count) {
  const auto last = static_cast<double>(count - 1);
  if (!(steps >= -kBeside && steps <= last + kBeside)) return std::nullopt;
  if (count == 1) return Place{0, 0, 0};
  const auto node = static_cast<std::size_t>(std::clamp(std::floor(steps), 0.0, last - 1));
  return Place{node, node + 1, std::clamp(steps - static_cast<double>(node), 0.0, 1.0)};
}

double between(double a, double b, double t) {
  return (1 - t) * a + t * b;
}

}  // namespace

// The values at the corners of a cell, and a place in it.
struct RasterField::Patch {
  double low_left, low_right, high_left, high_right;
  double t, s;  // along x and y
};

std::optional<std::string> RasterField::fault() const {
  if (!std::isfinite(origin.x) || !std::isfinite(origin.y)) return say("the origin is ", origin);
  if (!(dx > 0) || !(dy > 0) || std::isinf(dx) || std::isinf(dy))
    return say("the steps are ", dx, " and ", dy);
  const bool right =
      columns > 0 && rows > 0 && values.size() % columns == 0 && values.size() / columns == rows;
  if (!right) return say(values.size(), " values on ", columns, " x ", rows, " nodes");
  return std::nullopt;
}

auto RasterField::patch(Vec2 p) const -> std::optional<Patch> {
  const auto x = place((p.x - origin.x) / dx, columns);
  const auto y = place((p.y - origin.y) / dy, rows);
  if (!x || !y) return std::nullopt;
  const float* const low = &values[y->node * columns];
  const float* const high = &values[y->next * columns];
  return Patch{low[x->node], low[x->next], high[x->node], high[x->next], x->t, y->t};
}

double RasterField::value(Vec2 p) const {
  const auto at = patch(p);
  if (!at) return kNan;
  return between(between(at->low_left, at->low_right, at->t),
                 between(at->high_left, at->high_right, at->t), at->s);
}

double RasterField::slope(Vec2 p) const {
  const auto at = patch(p);
  if (!at) return kNan;
  const double along_x =
      between(at->low_right - at->low_left, at->high_right - at->high_left, at->s) / dx;
  const double along_y =
      between(at->high_left - at->low_left, at->high_right - at->low_right, at->t) / dy;
  return std::hypot(along_x, along_y);
}

}  // namespace weft::check

// SPDX-License-Identifier: Apache-2.0
#include "engine/size/fields/bilinear_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace weft {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
// How far beyond its nodes a grid still has values if it is undefined outside, in cells: half a
// pixel, and what a client may round when it computes the corner.
constexpr double kSlack = 0.5 + 0x1p-20;
// Covers ten roundings, of values up to the largest in absolute value: here and where a point is
// evaluated.
constexpr double kRounding = 0x1p-48;

// One component of the gradient, times the step: it goes from p on one side of the cell to q on the
// other.
double between(double p, double q, double t) {
  return std::clamp(p + t * (q - p), std::min(p, q), std::max(p, q));
}

// Bounds of the absolute value of `between` for t in an interval.
Interval lengths_between(double p, double q, Interval t) {
  double lo = std::min(p, q);
  double hi = std::max(p, q);
  if (t.lo > 0 || t.hi < 1) {
    const double from = between(p, q, t.lo);
    const double to = between(p, q, t.hi);
    const double rounding = kRounding * std::max(-lo, hi);
    lo = std::max(lo, std::min(from, to) - rounding);
    hi = std::min(hi, std::max(from, to) + rounding);
  }
  if (lo > 0) return {lo, hi, false};
  return {hi < 0 ? -hi : 0.0, std::max(-lo, hi), false};
}

// kUndefined if nothing was found: then no point has a value.
Interval known(const Interval& found) {
  return found.lo <= found.hi ? found : kUndefined;
}

}  // namespace

// Never falls as the coordinate grows, because subtraction and division do not: the bounds rest on
// it.
template <class T, Outside kOutside>
auto BilinearGrid<T, kOutside>::place(double coordinate, double origin, double step,
                                      std::uint32_t count) noexcept -> Place {
  const std::uint32_t last = count - 1;
  const double steps = (coordinate - origin) / step;
  const double within = steps > 0 ? std::min(steps, static_cast<double>(last)) : 0.0;
  const std::uint32_t node = std::min(static_cast<std::uint32_t>(within), last_cell(count));
  int side = 0;
  if constexpr (kOutside == Outside::kUndefined)
    side = steps < -kSlack ? -1 : steps <= last + kSlack ? 0 : 1;
  return {node, std::min(node + 1, last), within - node, side};
}

template <class T, Outside kOutside>
auto BilinearGrid<T, kOutside>::places(const Box& box) const noexcept -> Places {
  const Place left = place_x(box.min_x);
  const Place right = place_x(box.max_x);
  const Place bottom = place_y(box.min_y);
  const Place top = place_y(box.max_y);
  const auto beside = [](const Place& from, const Place& to) {
    return from.side != 0 && from.side == to.side;
  };
  return {left,
          right,
          bottom,
          top,
          right.node - left.node <= kAtATime && top.node - bottom.node <= kAtATime,
          left.side == 0 && right.side == 0 && bottom.side == 0 && top.side == 0,
          beside(left, right) || beside(bottom, top)};
}

template <class T, Outside kOutside>
double BilinearGrid<T, kOutside>::value(const Place& x, const Place& y) const noexcept {
  const double a = node(x.node, y.node);
  const double b = node(x.next, y.node);
  const double c = node(x.node, y.next);
  const double d = node(x.next, y.next);
  const double low = a + x.t * (b - a);
  const double high = c + x.t * (d - c);
  const double least = std::min(std::min(a, b), std::min(c, d));
  const double most = std::max(std::max(a, b), std::max(c, d));
  // Rounding hardly ever leaves the range of the four, but the clamp costs less than a proof that
  // it never does. A NaN passes through.
  return std::clamp(low + y.t * (high - low), least, most);
}

template <class T, Outside kOutside>
double BilinearGrid<T, kOutside>::slope(const Place& x, const Place& y) const noexcept {
  const double a = node(x.node, y.node);
  const double b = node(x.next, y.node);
  const double c = node(x.node, y.next);
  const double d = node(x.next, y.next);
  const double along_x = between(b - a, d - c, y.t) / shape_.dx;
  const double along_y = between(c - a, d - b, x.t) / shape_.dy;
  return std::sqrt(along_x * along_x + along_y * along_y);
}

template <class T, Outside kOutside>
void BilinearGrid<T, kOutside>::evaluate(std::size_t n, const double* x, const double* y,
                                         double* out) const noexcept {
  for (std::size_t k = 0; k < n; ++k) {
    const Place at_x = place_x(x[k]);
    const Place at_y = place_y(y[k]);
    out[k] = at_x.side == 0 && at_y.side == 0 ? value(at_x, at_y) : kNan;
  }
}

template <class T, Outside kOutside>
void BilinearGrid<T, kOutside>::evaluate_slope(std::size_t n, const double* x, const double* y,
                                               double* out) const noexcept {
  for (std::size_t k = 0; k < n; ++k) {
    const Place at_x = place_x(x[k]);
    const Place at_y = place_y(y[k]);
    out[k] = at_x.side == 0 && at_y.side == 0 ? slope(at_x, at_y) : kNan;
  }
}

template <class T, Outside kOutside>
Interval BilinearGrid<T, kOutside>::node_extremes(std::uint32_t i0, std::uint32_t i1,
                                                  std::uint32_t j0,
                                                  std::uint32_t j1) const noexcept {
  constexpr std::size_t kLanes = 4;  // so that the compiler uses vectors
  std::array<T, kLanes> lo;
  std::array<T, kLanes> hi;
  lo.fill(std::numeric_limits<T>::infinity());
  hi.fill(-std::numeric_limits<T>::infinity());
  bool undefined = false;
  const auto add_to = [&](std::size_t lane, T value) {
    lo[lane] = value < lo[lane] ? value : lo[lane];
    hi[lane] = value > hi[lane] ? value : hi[lane];
    if constexpr (kOutside == Outside::kUndefined) undefined |= value != value;
  };
  for (std::uint32_t j = j0; j <= j1; ++j) {
    const T* const values = row(j);
    std::size_t i = i0;
    for (; i + kLanes <= std::size_t{i1} + 1; i += kLanes)
      for (std::size_t lane = 0; lane < kLanes; ++lane) add_to(lane, values[i + lane]);
    for (; i <= i1; ++i) add_to(0, values[i]);
  }
  Interval found = kNoValue;
  for (std::size_t lane = 0; lane < kLanes; ++lane) add(found, {lo[lane], hi[lane], undefined});
  return found;
}

// For t and s in intervals.
template <class T, Outside kOutside>
void BilinearGrid<T, kOutside>::add_cell(std::uint32_t i, std::uint32_t j, Interval t, Interval s,
                                         Interval& to) const noexcept {
  const std::uint32_t next_i = std::min(i + 1, shape_.columns - 1);
  const std::uint32_t next_j = std::min(j + 1, shape_.rows - 1);
  const double a = node(i, j);
  const double b = node(next_i, j);
  const double c = node(i, next_j);
  const double d = node(next_i, next_j);
  if (std::isnan(a) || std::isnan(b) || std::isnan(c) || std::isnan(d)) {
    to.may_be_nan = true;
    return;
  }
  const Interval x = lengths_between(b - a, d - c, s);
  const Interval y = lengths_between(c - a, d - b, t);
  const auto length = [this](double along_x, double along_y) {
    return std::sqrt((along_x / shape_.dx) * (along_x / shape_.dx) +
                     (along_y / shape_.dy) * (along_y / shape_.dy));
  };
  add(to, {length(x.lo, y.lo), length(x.hi, y.hi), false});
}

template <class T, Outside kOutside>
Interval BilinearGrid<T, kOutside>::cell_extremes(std::uint32_t i0, std::uint32_t i1,
                                                  std::uint32_t j0,
                                                  std::uint32_t j1) const noexcept {
  Interval found = kNoValue;
  for (std::uint32_t j = j0; j <= j1; ++j)
    for (std::uint32_t i = i0; i <= i1; ++i) add_cell(i, j, {0, 1, false}, {0, 1, false}, found);
  return found;
}

template <class T, Outside kOutside>
std::optional<Error> BilinearGrid<T, kOutside>::build_bounds(const ExecutionContext& context) {
  return nodes_.build(
      shape_.columns, shape_.rows,
      [this](auto i0, auto i1, auto j0, auto j1) { return node_extremes(i0, i1, j0, j1); },
      context);
}

template <class T, Outside kOutside>
std::optional<Error> BilinearGrid<T, kOutside>::build_slope_bounds(
    const ExecutionContext& context) {
  return cells_.build(
      last_cell(shape_.columns) + 1, last_cell(shape_.rows) + 1,
      [this](auto i0, auto i1, auto j0, auto j1) { return cell_extremes(i0, i1, j0, j1); },
      context);
}

// The values are bilinear in each cell, so the extremes are at the corners of the pieces into which
// the cells cut the box.
template <class T, Outside kOutside>
Interval BilinearGrid<T, kOutside>::at_corners(const Places& box) const noexcept {
  using Stops = std::array<Place, kAtATime + 2>;
  const auto stops = [](const Place& from, const Place& to, Stops& places) {
    std::size_t count = 0;
    places[count++] = from;
    for (std::uint32_t i = from.node + 1; i <= to.node; ++i) places[count++] = {i, i, 0, 0};
    places[count++] = to;
    return count;
  };
  Stops xs;
  Stops ys;
  const std::size_t columns = stops(box.left, box.right, xs);
  const std::size_t rows = stops(box.bottom, box.top, ys);
  Interval found = kNoValue;
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) add(found, value(xs[i], ys[j]));
  return found;
}

template <class T, Outside kOutside>
Interval BilinearGrid<T, kOutside>::bounds(const Box& box) const noexcept {
  const Places at = places(box);
  if (at.outside) return kUndefined;
  const auto extremes = [this](auto i0, auto i1, auto j0, auto j1) {
    return nodes_.over(i0, i1, j0, j1, [this](auto k0, auto k1, auto l0, auto l1) {
      return node_extremes(k0, k1, l0, l1);
    });
  };
  const auto last = [](const Place& p) { return p.t > 0 ? p.next : p.node; };
  Interval nodes = extremes(at.left.node, last(at.right), at.bottom.node, last(at.top));
  // A cell with a NaN at a corner is undefined, even where that corner has no weight.
  if constexpr (kOutside == Outside::kUndefined)
    nodes.may_be_nan =
        !at.inside || nodes.may_be_nan ||
        extremes(at.left.node, at.right.next, at.bottom.node, at.top.next).may_be_nan;
  if (!at.few || nodes.lo >= nodes.hi) return known(nodes);

  const Interval found = at_corners(at);
  const double rounding = kRounding * std::max(-nodes.lo, nodes.hi);
  return known({std::max(found.lo - rounding, nodes.lo), std::min(found.hi + rounding, nodes.hi),
                nodes.may_be_nan});
}

template <class T, Outside kOutside>
Interval BilinearGrid<T, kOutside>::slope_bounds(const Box& box) const noexcept {
  const Places at = places(box);
  if (at.outside) return kUndefined;
  Interval found = kNoValue;
  if (at.few) {
    const auto part = [](std::uint32_t i, const Place& from, const Place& to) {
      return Interval{i == from.node ? from.t : 0, i == to.node ? to.t : 1, false};
    };
    for (std::uint32_t j = at.bottom.node; j <= at.top.node; ++j)
      for (std::uint32_t i = at.left.node; i <= at.right.node; ++i)
        add_cell(i, j, part(i, at.left, at.right), part(j, at.bottom, at.top), found);
  } else {
    found = cells_.over(
        at.left.node, at.right.node, at.bottom.node, at.top.node,
        [this](auto i0, auto i1, auto j0, auto j1) { return cell_extremes(i0, i1, j0, j1); });
  }
  found.may_be_nan = found.may_be_nan || !at.inside;
  return known(found);
}

template class BilinearGrid<double, Outside::kNearest>;
template class BilinearGrid<float, Outside::kUndefined>;

}  // namespace weft

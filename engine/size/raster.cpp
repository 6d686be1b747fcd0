// SPDX-License-Identifier: Apache-2.0
#include "engine/size/raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "engine/base/text.h"

namespace weft {
namespace {

constexpr Interval kNothing{std::numeric_limits<double>::infinity(),
                            -std::numeric_limits<double>::infinity(), false};

void add(Interval& to, double value) {
  to.lo = std::min(to.lo, value);
  to.hi = std::max(to.hi, value);
}

void add(Interval& to, const Interval& other) {
  to.lo = std::min(to.lo, other.lo);
  to.hi = std::max(to.hi, other.hi);
}

}  // namespace

std::optional<Error> check_raster_values(std::span<const double> values, std::uint32_t columns) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double value = values[i];
    if (value > 0 && std::isfinite(value)) continue;
    const std::string field = "size.raster.values[" + std::to_string(i) + "]";
    return Error{ErrorCode::kBadSizeValue, field,
                 field + " is " + text(value) + ", at column " + std::to_string(i % columns) +
                     " of row " + std::to_string(i / columns) +
                     "; a size must be positive and finite"};
  }
  return std::nullopt;
}

Result<RasterSize> RasterSize::make(const Raster& raster) {
  if (auto error = check_raster_values(raster.values, raster.columns))
    return tl::unexpected(*error);
  RasterSize size(raster);
  size.add_levels();
  return size;
}

void RasterSize::add_levels() {
  std::uint32_t columns = raster_->columns;
  std::uint32_t rows = raster_->rows;
  while (columns > kAtATime || rows > kAtATime) {
    const std::uint32_t wide = (columns + 1) / 2;
    const std::uint32_t high = (rows + 1) / 2;
    Level level{wide, std::vector<Interval>(std::size_t{wide} * high, kNothing)};
    for (std::uint32_t j = 0; j < rows; ++j) {
      for (std::uint32_t i = 0; i < columns; ++i) {
        Interval& block = level.blocks[std::size_t{j / 2} * wide + i / 2];
        if (levels_.empty())
          add(block, node(i, j));
        else
          add(block, levels_.back().blocks[std::size_t{j} * columns + i]);
      }
    }
    levels_.push_back(std::move(level));
    columns = wide;
    rows = high;
  }
}

std::size_t RasterSize::bytes() const noexcept {
  std::size_t bytes = raster_->values.capacity() * sizeof(double);
  for (const Level& level : levels_) bytes += level.blocks.capacity() * sizeof(Interval);
  return bytes;
}

// Never falls as the coordinate grows, for subtraction and division do not: the bounds rest on it.
RasterSize::Place RasterSize::place(double coordinate, double origin, double step,
                                    std::uint32_t count) noexcept {
  const std::uint32_t last = count - 1;
  const double steps = std::clamp((coordinate - origin) / step, 0.0, static_cast<double>(last));
  const auto node = static_cast<std::uint32_t>(steps);
  return {node, std::min(node + 1, last), steps - node};
}

double RasterSize::node(std::uint32_t i, std::uint32_t j) const noexcept {
  return raster_->values[std::size_t{j} * raster_->columns + i];
}

double RasterSize::value(const Place& x, const Place& y) const noexcept {
  const double a = node(x.node, y.node);
  const double b = node(x.next, y.node);
  const double c = node(x.node, y.next);
  const double d = node(x.next, y.next);
  const double low = a + x.t * (b - a);
  const double high = c + x.t * (d - c);
  const double least = std::min(std::min(a, b), std::min(c, d));
  const double most = std::max(std::max(a, b), std::max(c, d));
  // Rounding is hardly ever at odds with this; the clamp costs less than the proof of never.
  return std::clamp(low + y.t * (high - low), least, most);
}

void RasterSize::evaluate(std::size_t n, const double* x, const double* y,
                          double* out) const noexcept {
  const Raster& r = *raster_;
  for (std::size_t i = 0; i < n; ++i)
    out[i] = value(place(x[i], r.origin.x, r.dx, r.columns), place(y[i], r.origin.y, r.dy, r.rows));
}

Interval RasterSize::extremes(std::uint32_t i0, std::uint32_t i1, std::uint32_t j0,
                              std::uint32_t j1) const noexcept {
  std::size_t level = 0;  // levels_[level - 1]; 0: the nodes themselves
  while (level < levels_.size() &&
         ((i1 >> level) - (i0 >> level) > kAtATime || (j1 >> level) - (j0 >> level) > kAtATime))
    ++level;
  Interval found = kNothing;
  for (std::uint32_t j = j0 >> level; j <= j1 >> level; ++j) {
    for (std::uint32_t i = i0 >> level; i <= i1 >> level; ++i) {
      if (level == 0)
        add(found, node(i, j));
      else
        add(found, levels_[level - 1].blocks[std::size_t{j} * levels_[level - 1].columns + i]);
    }
  }
  return found;
}

Interval RasterSize::bounds(const Box& box) const noexcept {
  const Raster& r = *raster_;
  const Place left = place(box.min_x, r.origin.x, r.dx, r.columns);
  const Place right = place(box.max_x, r.origin.x, r.dx, r.columns);
  const Place bottom = place(box.min_y, r.origin.y, r.dy, r.rows);
  const Place top = place(box.max_y, r.origin.y, r.dy, r.rows);
  const auto last = [](const Place& p) { return p.t > 0 ? p.next : p.node; };
  const Interval nodes = extremes(left.node, last(right), bottom.node, last(top));
  const bool few = right.node - left.node <= kAtATime && top.node - bottom.node <= kAtATime;
  if (!few || nodes.lo == nodes.hi) return nodes;

  // Bilinear in each cell: the extremes are at the corners of what the box cuts out of the cells.
  using Places = std::array<Place, kAtATime + 2>;
  const auto stops = [](const Place& from, const Place& to, Places& places) {
    std::size_t count = 0;
    places[count++] = from;
    for (std::uint32_t i = from.node + 1; i <= to.node; ++i) places[count++] = {i, i, 0};
    places[count++] = to;
    return count;
  };
  Places xs;
  Places ys;
  const std::size_t columns = stops(left, right, xs);
  const std::size_t rows = stops(bottom, top, ys);
  Interval found = kNothing;
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) add(found, value(xs[i], ys[j]));
  // Nine roundings of values up to the largest node, here and where a point is evaluated.
  const double rounding = 0x1p-48 * nodes.hi;
  return {std::max(found.lo - rounding, nodes.lo), std::min(found.hi + rounding, nodes.hi), false};
}

}  // namespace weft

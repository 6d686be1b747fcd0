// SPDX-License-Identifier: Apache-2.0
#include "files/formats/rasters/raster_window.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "files/base/text.h"

namespace weft::files {
namespace {

constexpr float kNoData = std::numeric_limits<float>::quiet_NaN();
constexpr std::int64_t kMargin = 2;  // nodes on each side of the box
// The most values to average: more would take minutes.
constexpr double kMaxRead = 1e11;
// Values that are held in memory while they are averaged.
constexpr std::int64_t kTileValues = std::int64_t{1} << 22;

// Nodes of an axis, counted from the grid's first one. They may lie outside of the grid if it
// continues there by a turn.
struct Nodes {
  std::int64_t first = 0;
  std::int64_t count = 0;
};

// How a grid is laid over the box.
struct Placed {
  double x = 0;             // of column 0
  std::int64_t period = 0;  // column i + period is column i; 0 if the grid does not wrap around
};

// What is to be read: means over squares of factor_x * factor_y nodes, from the first node on.
struct Plan {
  std::size_t grid = 0;
  Placed placed;
  Nodes columns, rows;
  std::int64_t factor_x = 1;
  std::int64_t factor_y = 1;

  std::int64_t out_columns() const { return (columns.count + factor_x - 1) / factor_x; }
  std::int64_t out_rows() const { return (rows.count + factor_y - 1) / factor_y; }
  double values() const {
    return static_cast<double>(out_columns()) * static_cast<double>(out_rows());
  }
};

std::string text(const RasterBox& box) {
  return coordinates(box.min_x, box.min_y) + " to " + coordinates(box.max_x, box.max_y);
}

// The nodes between the two numbers, and `margin` more on each side.
Nodes nodes_between(double low, double high, double first, double step, std::int64_t margin) {
  const auto node = [&](double at) { return std::clamp((at - first) / step, -1e12, 1e12); };
  const auto begin = static_cast<std::int64_t>(std::ceil(node(low))) - margin;
  const auto end = static_cast<std::int64_t>(std::floor(node(high))) + margin + 1;
  return {begin, end - begin};
}

Nodes intersection(Nodes nodes, std::int64_t count) {
  const std::int64_t begin = std::clamp<std::int64_t>(nodes.first, 0, count - 1);
  const std::int64_t end = std::clamp<std::int64_t>(nodes.first + nodes.count, begin + 1, count);
  return {begin, end - begin};
}

std::int64_t modulo(std::int64_t a, std::int64_t period) {
  return ((a % period) + period) % period;
}

// Drops the columns before the first one, and after the last one, that has values.
Nodes with_values(Nodes nodes, std::int64_t columns, std::int64_t period) {
  std::int64_t begin = nodes.first;
  std::int64_t end = nodes.first + std::min(nodes.count, 2 * period);
  if (const std::int64_t at = modulo(begin, period); at >= columns) begin += period - at;
  if (const std::int64_t at = modulo(end - 1, period); at >= columns) end -= at - columns + 1;
  return {begin, std::max<std::int64_t>(end - begin, 1)};
}

class Window {
 public:
  Window(RasterSource& source, const RasterBox& box, std::uint64_t max_values)
      : source_(source), shape_(source.shape()), box_(box), max_values_(max_values) {}

  Result<FieldRaster> read() {
    if (!place()) return apart();
    const Plan plan = best_plan();
    if (const double nodes =
            static_cast<double>(plan.columns.count) * static_cast<double>(plan.rows.count);
        nodes > kMaxRead)
      return fail(ExitCode::kUnreadableInput,
                  shape_.name + ": " + shortest(nodes) +
                      " values in the domain's box; make overviews of the raster (gdaladdo)");
    lay_out(plan);
    const bool averaged = plan.factor_x > 1 || plan.factor_y > 1;
    if (auto done = averaged ? read_means(plan)
                             : read_tile(plan, 0, plan.columns.count, 0, plan.rows.count,
                                         out_.values.data());
        !done)
      return tl::unexpected(done.error());
    if (averaged || plan.grid > 0)
      out_.warnings.push_back(shape_.name + ": read at a resolution of " +
                              coordinates(out_.dx, out_.dy) + ", not its own of " +
                              coordinates(shape_.grids[0].dx, shape_.grids[0].dy) +
                              ", because the domain's box has more than " +
                              with_separators(max_values_) + " of its values");
    if (std::all_of(out_.values.begin(), out_.values.end(), [](float v) { return std::isnan(v); }))
      out_.warnings.push_back(shape_.name + ": has no data in the domain's box");
    return std::move(out_);
  }

 private:
  // The number of turns by which the raster is shifted; false if it does not meet the box.
  bool place() {
    const RasterBox extent = shape_.grids[0].extent();
    if (extent.max_y < box_.min_y || extent.min_y > box_.max_y) return false;
    const auto overlap = [&](int turns) {
      const double shift = turns * turn_;
      return std::min(box_.max_x, extent.max_x + shift) -
             std::max(box_.min_x, extent.min_x + shift);
    };
    turn_ = shape_.turn;
    const bool goes_round = looks_like_degrees(shape_.grids[0]) &&
                            std::abs(extent.max_x - extent.min_x - 360) < 1.5 * shape_.grids[0].dx;
    const bool guessed = shape_.crs.empty() && looks_like_degrees(shape_.grids[0]);
    if (guessed && (goes_round || overlap(0) < 0)) turn_ = 360;
    int best = 0;
    if (turn_ > 0 && std::max(std::abs(box_.min_x), std::abs(box_.max_x)) <= 1.5 * turn_)
      for (const int turns : {-1, 1, -2, 2})
        if (overlap(turns) > overlap(best)) best = turns;
    if (!(overlap(best) >= 0)) return false;
    if (guessed && best != 0 && !goes_round)
      out_.warnings.push_back(shape_.name +
                              ": has no coordinate system; its x are taken for "
                              "longitudes, and shifted by " +
                              shortest(best * turn_));
    shift_ = best * turn_;
    return true;
  }

  tl::unexpected<Error> apart() const {
    return fail(ExitCode::kUnreadableInput,
                shape_.name + ": the raster, " + text(shape_.grids[0].extent()) +
                    (shape_.crs.empty() ? "" : " in " + harmless(shape_.crs)) +
                    ", does not meet the domain's box, " + text(box_));
  }

  Plan plan(std::size_t index, std::int64_t factor) const {
    const RasterGrid& grid = shape_.grids[index];
    Plan plan{index, {grid.x + shift_, 0}, {}, {}, 1, 1};
    // A seam counts only if it meets the nodes to within a tenth of a cell.
    if (const double period = turn_ / grid.dx;
        turn_ > 0 && period < 1e9 && period > 1.5 && std::abs(period - std::round(period)) <= 0.1)
      plan.placed.period = static_cast<std::int64_t>(std::round(period));
    const std::int64_t margin = kMargin * factor;
    plan.columns = nodes_between(box_.min_x, box_.max_x, plan.placed.x, grid.dx, margin);
    plan.columns = plan.placed.period > 0
                       ? with_values(plan.columns, grid.columns, plan.placed.period)
                       : intersection(plan.columns, grid.columns);
    plan.rows =
        intersection(nodes_between(box_.min_y, box_.max_y, grid.y, grid.dy, margin), grid.rows);
    plan.factor_x = std::min(factor, plan.columns.count);
    plan.factor_y = std::min(factor, plan.rows.count);
    return plan;
  }

  // The plan for one grid that averages least.
  Plan plan_of_grid(std::size_t index) const {
    const auto most = static_cast<double>(max_values_);
    Plan found = plan(index, 1);
    for (std::int64_t factor = 1; found.values() > most; found = plan(index, factor))
      factor = std::max(factor + 1, static_cast<std::int64_t>(std::sqrt(found.values() / most) *
                                                              static_cast<double>(factor)));
    return found;
  }

  // The plan with most values; of several, the one of the coarsest grid, which is read fastest.
  Plan best_plan() const {
    Plan best = plan_of_grid(0);
    if (best.factor_x == 1 && best.factor_y == 1) return best;
    for (std::size_t i = 1; i < shape_.grids.size(); ++i)
      if (const Plan other = plan_of_grid(i); other.values() >= best.values()) best = other;
    return best;
  }

  void lay_out(const Plan& plan) {
    const RasterGrid& grid = shape_.grids[plan.grid];
    const auto place = [](double first, double step, const Nodes& nodes, std::int64_t factor) {
      return first +
             (static_cast<double>(nodes.first) + static_cast<double>(factor - 1) / 2) * step;
    };
    out_.x = place(plan.placed.x, grid.dx, plan.columns, plan.factor_x);
    out_.y = place(grid.y, grid.dy, plan.rows, plan.factor_y);
    out_.dx = grid.dx * static_cast<double>(plan.factor_x);
    out_.dy = grid.dy * static_cast<double>(plan.factor_y);
    out_.columns = static_cast<std::uint32_t>(plan.out_columns());
    out_.rows = static_cast<std::uint32_t>(plan.out_rows());
    out_.values.assign(std::size_t{out_.columns} * out_.rows, kNoData);
  }

  // Reads the plan's columns and rows into `out`, row by row. REQUIRES: `out` holds NaN.
  Result<void> read_tile(const Plan& plan, std::int64_t column, std::int64_t columns,
                         std::int64_t row, std::int64_t rows, float* out) {
    const RasterGrid& grid = shape_.grids[plan.grid];
    const std::int64_t begin = plan.columns.first + column;
    const std::int64_t period = plan.placed.period > 0 ? plan.placed.period : grid.columns;
    const std::int64_t width = std::min<std::int64_t>(grid.columns, period);
    for (std::int64_t i = begin; i < begin + columns;) {
      const std::int64_t at = modulo(i, period);
      const std::int64_t count = std::min((at < width ? width : period) - at, begin + columns - i);
      if (at < width) {
        const RasterPart part{static_cast<std::uint32_t>(at),
                              static_cast<std::uint32_t>(plan.rows.first + row),
                              static_cast<std::uint32_t>(count), static_cast<std::uint32_t>(rows)};
        if (auto done =
                source_.read(plan.grid, part, out + (i - begin), static_cast<std::size_t>(columns));
            !done)
          return done;
      }
      i += count;
    }
    return {};
  }

  Result<void> read_means(const Plan& plan) {
    const std::int64_t square = plan.factor_x * plan.factor_y;
    const std::int64_t most_columns =
        std::clamp<std::int64_t>(kTileValues / square, 1, plan.out_columns());
    const std::int64_t most_rows =
        std::clamp<std::int64_t>(kTileValues / square / most_columns, 1, plan.out_rows());
    for (std::int64_t row = 0; row < plan.out_rows(); row += most_rows)
      for (std::int64_t column = 0; column < plan.out_columns(); column += most_columns)
        if (auto done = read_tile_of_means(plan, column, most_columns, row, most_rows); !done)
          return done;
    return {};
  }

  // Means from (column, row) on; at most as many as fit in memory.
  Result<void> read_tile_of_means(const Plan& plan, std::int64_t column, std::int64_t most_columns,
                                  std::int64_t row, std::int64_t most_rows) {
    const std::int64_t fx = plan.factor_x;
    const std::int64_t fy = plan.factor_y;
    const std::int64_t columns = std::min(most_columns * fx, plan.columns.count - column * fx);
    const std::int64_t rows = std::min(most_rows * fy, plan.rows.count - row * fy);
    tile_.assign(static_cast<std::size_t>(columns * rows), kNoData);
    if (auto done = read_tile(plan, column * fx, columns, row * fy, rows, tile_.data()); !done)
      return done;
    for (std::int64_t j = 0; j < rows; j += fy)
      for (std::int64_t i = 0; i < columns; i += fx) {
        double sum = 0;
        std::int64_t count = 0;
        for (std::int64_t b = j; b < std::min(j + fy, rows); ++b)
          for (std::int64_t a = i; a < std::min(i + fx, columns); ++a)
            if (const float value = tile_[static_cast<std::size_t>(b * columns + a)];
                !std::isnan(value)) {
              sum += value;
              ++count;
            }
        if (count > 0)
          out_.values[static_cast<std::size_t>((row + j / fy) * plan.out_columns() + column +
                                               i / fx)] =
              static_cast<float>(sum / static_cast<double>(count));
      }
    return {};
  }

  RasterSource& source_;
  const RasterShape& shape_;
  const RasterBox box_;
  const std::uint64_t max_values_;
  double turn_ = 0;
  double shift_ = 0;
  FieldRaster out_;
  std::vector<float> tile_;
};

}  // namespace

float field_value(double value) {
  return std::abs(value) <= std::numeric_limits<float>::max() ? static_cast<float>(value) : kNoData;
}

bool looks_like_degrees(const RasterGrid& grid) {
  const RasterBox extent = grid.extent();
  return extent.min_x >= -360 - grid.dx && extent.max_x <= 360 + grid.dx &&
         extent.max_x - extent.min_x <= 360 + 1.5 * grid.dx && extent.min_y >= -90 - grid.dy &&
         extent.max_y <= 90 + grid.dy;
}

Result<FieldRaster> read_window(RasterSource& source, const RasterBox& box,
                                std::uint64_t max_values) {
  return Window(source, box, max_values).read();
}

}  // namespace weft::files

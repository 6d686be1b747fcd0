// SPDX-License-Identifier: Apache-2.0
#include "files/formats/rasters/projected_window.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "files/base/text.h"
#include "files/formats/rasters/raster_window.h"

namespace weft::files {
namespace {

constexpr float kNoData = std::numeric_limits<float>::quiet_NaN();

// The difference of two x, without whole turns.
double short_way(double difference, double turn) {
  return turn > 0 ? difference - turn * std::round(difference / turn) : difference;
}

// The box of the raster that holds the box of the plane, and some more; nullopt if no point of the
// border has a counterpart. The inside of the border maps to the inside of its image, except at a
// pole, which has no longitude: there the longitudes along the border make a turn, or jump.
std::optional<RasterBox> box_in_raster(const PlaneToRaster& from_plane, const RasterBox& box,
                                       double turn) {
  constexpr int kSteps = 256;
  std::vector<double> x, y;
  const double width = box.max_x - box.min_x;
  const double height = box.max_y - box.min_y;
  for (int side = 0; side < 4; ++side)
    for (int i = 0; i < kSteps; ++i) {
      const double t = (side < 2 ? i : kSteps - i) / static_cast<double>(kSteps);
      x.push_back(side % 2 == 0 ? box.min_x + t * width : side == 1 ? box.max_x : box.min_x);
      y.push_back(side % 2 == 1 ? box.min_y + t * height : side == 0 ? box.min_y : box.max_y);
    }
  x.push_back(x[0]);
  y.push_back(y[0]);
  from_plane.transform(x.size(), x.data(), y.data(), 0);

  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  RasterBox found{kInfinity, kInfinity, -kInfinity, -kInfinity};
  double at = 0;     // x, continued along the border
  double first = 0;  // where it started
  bool begun = false;
  bool jumps = false;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::isnan(x[i])) continue;
    const double step = begun ? short_way(x[i] - at, turn) : 0;
    jumps |= turn > 0 && std::abs(step) > turn / 4;
    at = begun ? at + step : x[i];
    if (!begun) first = at;
    begun = true;
    found = {std::min(found.min_x, at), std::min(found.min_y, y[i]), std::max(found.max_x, at),
             std::max(found.max_y, y[i])};
  }
  if (!begun) return std::nullopt;
  const double pad_y = (found.max_y - found.min_y) / 64;
  found.min_y -= pad_y;
  found.max_y += pad_y;
  if (turn > 0 && (jumps || std::abs(at - first) > turn / 2)) {
    const double middle = (found.min_y + found.max_y) / 2;
    (middle > 0 ? found.max_y : found.min_y) = std::copysign(turn / 4, middle);
    return RasterBox{-turn / 2, found.min_y, turn / 2, found.max_y};
  }
  const double pad_x = (found.max_x - found.min_x) / 64;
  // The turn that is nearest to the origin, in whatever turn the border began.
  const double shift = turn > 0 ? short_way(found.min_x, turn) - found.min_x : 0;
  found.min_x += shift - pad_x;
  found.max_x += shift + pad_x;
  return found;
}

// The edge of a square of the plane that is as large as a cell of the raster, around the middle of
// the box's points; nullopt if none of them has a counterpart.
std::optional<double> cell_size(const PlaneToRaster& from_plane, const RasterBox& box,
                                const RasterGrid& raster, double turn) {
  constexpr int kPoints = 7;
  const double step = std::max(box.max_x - box.min_x, box.max_y - box.min_y) / 1024;
  std::vector<double> sizes;
  for (int i = 0; i < kPoints; ++i)
    for (int j = 0; j < kPoints; ++j) {
      const double px = box.min_x + (box.max_x - box.min_x) * (i + 0.5) / kPoints;
      const double py = box.min_y + (box.max_y - box.min_y) * (j + 0.5) / kPoints;
      double x[] = {px, px + step, px};
      double y[] = {py, py, py + step};
      from_plane.transform(3, x, y, 0);
      const double cells = std::abs(short_way(x[1] - x[0], turn) * (y[2] - y[0]) -
                                    short_way(x[2] - x[0], turn) * (y[1] - y[0])) /
                           (raster.dx * raster.dy);
      const double size = step / std::sqrt(cells);
      if (std::isfinite(size) && size > 0) sizes.push_back(size);
    }
  if (sizes.empty()) return std::nullopt;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return *middle;
}

// Bilinear between the nodes with data, if the nearest node has data. Within kBeside cells around
// the nodes, the values at the border go on. A field is undefined in a cell with an undefined
// corner; so the corners of the plane's cells in which the raster ends are defined, and a raster
// that just covers the domain is enough.
class Bilinear {
 public:
  Bilinear(const FieldRaster& raster, double turn)
      : raster_(raster), period_(turn > 0 ? turn / raster.dx : 0) {}

  float operator()(double x, double y) const {
    double u = (x - raster_.x) / raster_.dx;
    double v = (y - raster_.y) / raster_.dy;
    if (period_ > 0) u -= period_ * std::floor((u + 0.5) / period_);
    constexpr double kBeside = 2;  // cells
    if (!(u >= -kBeside && u <= raster_.columns - 1 + kBeside && v >= -kBeside &&
          v <= raster_.rows - 1 + kBeside))
      return kNoData;
    u = std::clamp(u, 0.0, raster_.columns - 1.0);
    v = std::clamp(v, 0.0, raster_.rows - 1.0);
    if (std::isnan(node(std::round(u), std::round(v)))) return kNoData;
    const double i = std::floor(u);
    const double j = std::floor(v);
    double sum = 0;
    double weights = 0;
    const auto add = [&](double column, double row, double weight) {
      if (weight == 0) return;
      const float value = node(column, row);
      if (std::isnan(value)) return;
      sum += weight * value;
      weights += weight;
    };
    add(i, j, (1 - (u - i)) * (1 - (v - j)));
    add(i + 1, j, (u - i) * (1 - (v - j)));
    add(i, j + 1, (1 - (u - i)) * (v - j));
    add(i + 1, j + 1, (u - i) * (v - j));
    return static_cast<float>(sum / weights);
  }

 private:
  float node(double column, double row) const {
    return raster_
        .values[static_cast<std::size_t>(row) * raster_.columns + static_cast<std::size_t>(column)];
  }

  const FieldRaster& raster_;
  double period_;  // in columns; 0 if the raster has none
};

// Square cells over the box, and two more nodes on each side.
FieldRaster grid_over(const RasterBox& box, double size, std::uint64_t max_values) {
  FieldRaster out;
  const double width = box.max_x - box.min_x;
  const double height = box.max_y - box.min_y;
  const auto nodes = [&](double length) { return std::ceil(length / size) + 5; };
  while (nodes(width) * nodes(height) > static_cast<double>(max_values)) size *= 1.01;
  out.x = box.min_x - 2 * size;
  out.y = box.min_y - 2 * size;
  out.dx = size;
  out.dy = size;
  out.columns = static_cast<std::uint32_t>(nodes(width));
  out.rows = static_cast<std::uint32_t>(nodes(height));
  return out;
}

}  // namespace

Result<FieldRaster> read_projected_window(RasterSource& source, const RasterBox& box,
                                          const std::string& crs, std::uint64_t max_values) {
  const RasterShape& shape = source.shape();
  const bool assumed = shape.crs.empty();
  if (assumed && !looks_like_degrees(shape.grids[0]))
    return fail(ExitCode::kUnreadableInput,
                shape.name +
                    ": has no coordinate system, and its coordinates are no degrees; "
                    "gdal_translate -a_srs gives it one");
  const double turn = assumed ? 360 : shape.turn;
  const auto from_plane = source.from_plane(crs);
  if (!from_plane) return tl::unexpected(from_plane.error());
  const auto no_counterpart = [&] {
    return fail(ExitCode::kUnreadableInput,
                shape.name + ": the domain's box, " + coordinates(box.min_x, box.min_y) + " to " +
                    coordinates(box.max_x, box.max_y) +
                    ", has no counterpart in the raster's coordinate system");
  };
  const auto size = cell_size(**from_plane, box, shape.grids[0], turn);
  if (!size) return no_counterpart();
  FieldRaster out = grid_over(box, *size, max_values);
  const auto part = box_in_raster(
      **from_plane,
      {out.x, out.y, out.x + (out.columns - 1) * out.dx, out.y + (out.rows - 1) * out.dy}, turn);
  if (!part) return no_counterpart();
  auto raster = read_window(source, *part, max_values);
  if (!raster) return raster;
  out.warnings = std::move(raster->warnings);
  if (assumed)
    out.warnings.push_back(shape.name +
                           ": has no coordinate system; its coordinates are taken for longitudes "
                           "and latitudes (EPSG:4326)");
  out.values.resize(std::size_t{out.columns} * out.rows);
  const Bilinear value(*raster, turn);
  const double tolerance = std::min(raster->dx, raster->dy) / 64;
  std::vector<double> x(out.columns);
  std::vector<double> y(out.columns);
  for (std::size_t row = 0; row < out.rows; ++row) {
    for (std::size_t i = 0; i < out.columns; ++i) x[i] = out.x + static_cast<double>(i) * out.dx;
    std::fill(y.begin(), y.end(), out.y + static_cast<double>(row) * out.dy);
    (*from_plane)->transform(out.columns, x.data(), y.data(), tolerance);
    for (std::size_t i = 0; i < out.columns; ++i)
      out.values[row * out.columns + i] = value(x[i], y[i]);
  }
  return out;
}

}  // namespace weft::files

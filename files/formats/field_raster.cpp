// SPDX-License-Identifier: Apache-2.0
#include "files/formats/field_raster.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <system_error>
#include <utility>

#include "files/formats/raster.h"
#include "files/formats/rasters/projected_window.h"
#include "files/formats/rasters/raster_source.h"
#include "files/formats/rasters/raster_window.h"

namespace weft::files {
namespace {

// Asks `each` for the degrees of few points of a row: between two of them, the points lie on a
// straight line if the point in the middle does, within the tolerance; else each half is judged by
// itself. `each` is slow, because it is PROJ.
class ToDegrees final : public PlaneToRaster {
 public:
  explicit ToDegrees(const std::function<Point(Point)>& each) : each_(each) {}

  void transform(std::size_t n, double* x, double* y, double tolerance) const override {
    std::vector<Point> points(n);
    for (std::size_t i = 0; i < n; ++i) points[i] = {x[i], y[i]};
    const auto fill = [&](std::size_t i) {
      const Point degrees = each_(points[i]);
      x[i] = degrees.x;
      y[i] = degrees.y;
    };
    if (n > 0) fill(0);
    for (std::size_t first = 0, last = 0; first + 1 < n; first = last) {
      last = std::min(first + kLongest, n - 1);
      fill(last);
      fill_between(first, last, tolerance, points, fill, x, y);
    }
  }

 private:
  static constexpr std::size_t kLongest = 64;

  // Those between two that are filled: on a straight line if the one in the middle is.
  template <class Fill>
  static void fill_between(std::size_t first, std::size_t last, double tolerance,
                           const std::vector<Point>& points, const Fill& fill, double* x,
                           double* y) {
    if (last - first < 2) return;
    const std::size_t middle = (first + last) / 2;
    const auto on_line = [&](std::size_t i) -> Point {
      const double t =
          std::hypot(points[i].x - points[first].x, points[i].y - points[first].y) /
          std::hypot(points[last].x - points[first].x, points[last].y - points[first].y);
      return {x[first] + t * (x[last] - x[first]), y[first] + t * (y[last] - y[first])};
    };
    fill(middle);
    const Point straight = on_line(middle);
    if (!(std::hypot(straight.x - x[middle], straight.y - y[middle]) < tolerance)) {
      fill_between(first, middle, tolerance, points, fill, x, y);
      fill_between(middle, last, tolerance, points, fill, x, y);
      return;
    }
    for (std::size_t i = first + 1; i < last; ++i) {
      const Point at = on_line(i);
      x[i] = at.x;
      y[i] = at.y;
    }
  }

  const std::function<Point(Point)>& each_;
};

// An ESRI ASCII grid, as raster.h reads it.
class AsciiSource final : public RasterSource {
 public:
  // `to_degrees` outlives it, and is called from one thread at a time.
  AsciiSource(const std::filesystem::path& path, Raster raster,
              const std::function<Point(Point)>* to_degrees = nullptr)
      : raster_(std::move(raster)), to_degrees_(to_degrees) {
    shape_.name = path.string();
    shape_.grids.push_back(
        {raster_.x, raster_.y, raster_.dx, raster_.dy, raster_.columns, raster_.rows});
  }

  Result<void> read(std::size_t, const RasterPart& part, float* out, std::size_t stride) override {
    for (std::size_t j = 0; j < part.rows; ++j) {
      const auto row = raster_.values.begin() +
                       static_cast<std::ptrdiff_t>((part.row + j) * raster_.columns + part.column);
      std::transform(row, row + part.columns, out + j * stride, field_value);
    }
    return {};
  }

  bool is_in(const CoordinateSystem&) const override { return true; }

  Result<std::unique_ptr<PlaneToRaster>> from_plane(const std::string&) override {
    if (to_degrees_ == nullptr)
      return fail(ExitCode::kInternal, shape_.name + ": was not opened with GDAL");
    return std::make_unique<ToDegrees>(*to_degrees_);
  }

 private:
  Raster raster_;
  const std::function<Point(Point)>* to_degrees_;
};

Result<std::unique_ptr<RasterSource>> open_ascii(const std::filesystem::path& path,
                                                 const std::string& band) {
  if (!band.empty() && band != "1")
    return fail(ExitCode::kUnreadableInput, path.string() + ": has one band, not a band " + band);
  auto raster = read_raster(path, RasterValues::kAny);
  if (!raster) return tl::unexpected(raster.error());
  return std::make_unique<AsciiSource>(path, std::move(*raster));
}

Result<std::unique_ptr<RasterSource>> open(const std::filesystem::path& path,
                                           const std::string& band) {
  if (auto found = must_be_raster_file(path); !found) return tl::unexpected(found.error());
  return is_raster_path(path) ? open_ascii(path, band) : open_with_gdal(path, band);
}

}  // namespace

Result<void> must_be_raster_file(const std::filesystem::path& path) {
  std::error_code problem;
  if (path.string().starts_with("/vsi") || std::filesystem::exists(path, problem)) return {};
  return fail(ExitCode::kUnreadableInput,
              path.string() + ": " + (problem ? problem.message() : "no such file"));
}

Result<FieldRaster> read_field_raster(const std::filesystem::path& path, const std::string& band,
                                      const RasterBox& box, std::uint64_t max_values) {
  const auto source = open(path, band);
  if (!source) return tl::unexpected(source.error());
  return read_window(**source, box, max_values);
}

Result<FieldRaster> read_field_raster_in(const std::filesystem::path& path, const std::string& band,
                                         const RasterBox& box, const CoordinateSystem& system,
                                         std::uint64_t max_values) {
  const auto source = open(path, band);
  if (!source) return tl::unexpected(source.error());
  if ((*source)->is_in(system)) return read_window(**source, box, max_values);
  return read_projected_window(**source, box, system.definition, max_values);
}

Result<FieldRaster> read_field_raster_projected(const std::filesystem::path& path,
                                                const std::string& band, const RasterBox& box,
                                                const std::string& crs, std::uint64_t max_values) {
  if (auto found = must_be_raster_file(path); !found) return tl::unexpected(found.error());
  const auto source = open_with_gdal(path, band);
  if (!source) return tl::unexpected(source.error());
  return read_projected_window(**source, box, crs, max_values);
}

Result<FieldRaster> read_ascii_field(const std::filesystem::path& path, const RasterBox& box,
                                     const std::function<Point(Point)>& to_degrees,
                                     std::uint64_t max_values) {
  auto raster = read_raster(path, RasterValues::kAny);
  if (!raster) return tl::unexpected(raster.error());
  AsciiSource source(path, std::move(*raster), &to_degrees);
  return to_degrees ? read_projected_window(source, box, "", max_values)
                    : read_window(source, box, max_values);
}

RasterPath split_raster_path(std::string_view text) {
  std::error_code ignored;
  for (std::size_t colon = text.find(':'); colon != std::string_view::npos;
       colon = text.find(':', colon + 1))
    if (const std::filesystem::path file = text.substr(0, colon);
        std::filesystem::is_regular_file(file, ignored))
      return {file, std::string(text.substr(colon + 1))};
  return {text, ""};
}

}  // namespace weft::files

// SPDX-License-Identifier: Apache-2.0
#include "server/wire/size_field.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>

namespace weft::server {
namespace {

Failure bad_grid(std::string_view name, double value, std::string_view what) {
  std::string field = fmt::format("size.raster.{}", name);
  std::string message = fmt::format("{} is {}; it must be {}", field, value, what);
  return {Reason::kBadOption, std::move(field), std::move(message)};
}

std::optional<Failure> check_grid(const v1::Raster& raster) {
  for (const auto& [name, value] : {std::pair{"x", raster.x()}, std::pair{"y", raster.y()}})
    if (!std::isfinite(value)) return bad_grid(name, value, "finite");
  for (const auto& [name, value] : {std::pair{"dx", raster.dx()}, std::pair{"dy", raster.dy()}})
    if (!(std::isfinite(value) && value > 0)) return bad_grid(name, value, "positive and finite");
  const std::uint64_t nodes = std::uint64_t{raster.columns()} * raster.rows();
  if (nodes == 0 || nodes != static_cast<std::uint64_t>(raster.values_size()))
    return Failure{Reason::kBadArray, "size.raster.values",
                   fmt::format("size.raster.values holds {} values for {} columns and {} rows; it "
                               "takes one a node, and one node at least",
                               raster.values_size(), raster.columns(), raster.rows())};
  return std::nullopt;
}

// The size whose triangles are those of up to kSamples nodes, on average.
double mean_size(const v1::Raster& raster) {
  constexpr int kSamples = 1024;
  const int step = 1 + raster.values_size() / kSamples;
  double sum = 0;
  int count = 0;
  for (int i = 0; i < raster.values_size(); i += step, ++count)
    sum += raster.values(i) > 0 ? 1 / raster.values(i) : 0;
  return count / sum;
}

}  // namespace

std::optional<Failure> check_shape(const v1::SizeField& size) {
  return size.has_raster() ? check_grid(size.raster()) : std::nullopt;
}

std::optional<Failure> check_values(const v1::SizeField& size) {
  std::optional<Error> error;
  if (size.has_raster()) {
    const auto& values = size.raster().values();
    error = check_raster_values({values.data(), static_cast<std::size_t>(values.size())},
                                size.raster().columns());
  } else {
    const SizeSpec spec = to_engine(size);
    if (auto made = make_size(spec); !made) error = made.error();
  }
  return error ? std::optional(failure_of(*error)) : std::nullopt;
}

SizeSpec to_engine(const v1::SizeField& size) {
  switch (size.field_case()) {
    case v1::SizeField::kConstant:
      return size.constant();
    case v1::SizeField::kExpression:
      return size.expression();
    case v1::SizeField::kRaster: {
      const v1::Raster& raster = size.raster();
      return Raster{{raster.x(), raster.y()},
                    raster.dx(),
                    raster.dy(),
                    raster.columns(),
                    raster.rows(),
                    {raster.values().begin(), raster.values().end()}};
    }
    case v1::SizeField::FIELD_NOT_SET:
      break;
  }
  return {};
}

std::unique_ptr<const SizeFunction> size_to_estimate_by(const v1::SizeField& size) {
  const SizeSpec spec = size.has_raster() ? mean_size(size.raster()) : to_engine(size);
  auto made = make_size(spec);
  if (!made) made = make_size(SizeSpec{});
  return std::move(*made);
}

double bytes_to_expect(const v1::SizeField& size) {
  return static_cast<double>(RasterSize::kBytesPerValue) * size.raster().values_size();
}

}  // namespace weft::server

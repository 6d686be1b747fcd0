// SPDX-License-Identifier: Apache-2.0
#include "server/weight.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/geometry.h"
#include "engine/size/expression.h"

namespace weft::server {
namespace {

// As measured: 46 bytes a triangle of the engine and 8 MiB of chunks on their way, 300 bytes a
// point for the constrained triangulation.
constexpr double kBytesPerTriangle = 48;
constexpr double kBytesPerPoint = 300;
constexpr double kBytesPerJob = 16 << 20;
// A size raster's own, and those of its blocks (engine/size/raster.h).
constexpr double kBytesPerRasterValue = 16;
// Triangles of a uniform mesh times the bound over the area, with circumcentres and where no
// lattice fits the size: on a lattice there are a third fewer. Angles alone ask for about ten
// triangles a point.
constexpr double kTrianglesPerArea = 1.55;
constexpr double kTrianglesPerPoint = 10;

Box box_of(const google::protobuf::RepeatedField<double>& points) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Box box{kInfinity, kInfinity, -kInfinity, -kInfinity};
  for (int i = 0; i + 1 < points.size(); i += 2) {
    box.min_x = std::min(box.min_x, points[i]);
    box.max_x = std::max(box.max_x, points[i]);
    box.min_y = std::min(box.min_y, points[i + 1]);
    box.max_y = std::max(box.max_y, points[i + 1]);
  }
  return box;
}

double inverse(double bound) {
  return bound > 0 ? 1 / bound : 0;  // what is no bound is for the engine to refuse
}

double mean_inverse(const Expression& size, const Box& box) {
  constexpr int kSamples = 32;  // each way
  double sum = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double y = std::lerp(box.min_y, box.max_y, (i + 0.5) / kSamples);
    alignas(64) double xs[kSamples];
    alignas(64) double ys[kSamples];
    alignas(64) double bounds[kSamples];
    for (int j = 0; j < kSamples; ++j) {
      xs[j] = std::lerp(box.min_x, box.max_x, (j + 0.5) / kSamples);
      ys[j] = y;
    }
    size.evaluate(kSamples, xs, ys, bounds);
    for (const double bound : bounds) sum += inverse(bound);
  }
  return sum / (kSamples * kSamples);
}

// The raster stands for the domain.
double mean_inverse(const v1::Raster& raster) {
  constexpr int kSamples = 1024;
  const int step = 1 + raster.values_size() / kSamples;
  double sum = 0;
  int count = 0;
  for (int i = 0; i < raster.values_size(); i += step, ++count) sum += inverse(raster.values(i));
  return sum / count;
}

double expected_triangles(const v1::GenerateMeshRequest& request) {
  const auto& points = request.domain().points();
  double per_area = 0;
  const Box box = box_of(points);
  if (request.size().has_constant()) {
    per_area = inverse(request.size().constant());
  } else if (request.size().has_expression()) {
    const auto size = Expression::parse(request.size().expression());
    if (size) per_area = mean_inverse(*size, box);
  } else if (request.size().has_raster()) {
    per_area = mean_inverse(request.size().raster());
  }
  const double area = (box.max_x - box.min_x) * (box.max_y - box.min_y);
  return kTrianglesPerPoint * points.size() / 2 + kTrianglesPerArea * per_area * area;
}

}  // namespace

std::uint64_t expected_bytes(const v1::GenerateMeshRequest& request, const Limits& limits) {
  const std::uint64_t most =
      request.budget().max_bytes() != 0 ? request.budget().max_bytes() : limits.max_bytes;
  const std::uint64_t most_triangles = request.budget().max_triangles() != 0
                                           ? request.budget().max_triangles()
                                           : limits.max_triangles;
  const double triangles =
      std::min(expected_triangles(request), static_cast<double>(most_triangles));
  const double bytes = kBytesPerJob + kBytesPerPoint * request.domain().points_size() / 2 +
                       kBytesPerRasterValue * request.size().raster().values_size() +
                       kBytesPerTriangle * triangles;
  // Not `min` alone: coordinates that are not finite make it NaN.
  return bytes < static_cast<double>(most) ? static_cast<std::uint64_t>(bytes) : most;
}

}  // namespace weft::server

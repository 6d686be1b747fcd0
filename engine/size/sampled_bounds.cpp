// SPDX-License-Identifier: Apache-2.0
#include "engine/size/sampled_bounds.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "engine/size/fields/polled_loop.h"
#include "engine/size/fields/triangle_tree.h"

namespace weft {
namespace {

constexpr std::size_t kAtOnce = 256;  // points
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

std::uint64_t bytes_to_sample(const Domain& domain, std::size_t points) {
  return TriangleTree::bytes_to_build(domain.triangles.size()) + points * sizeof(double);
}

Result<std::vector<double>> sampled_bounds(const SizeFunction& size, const Domain& domain,
                                           std::span<const Point> points,
                                           const ExecutionContext& context) {
  const std::size_t count = domain.triangles.size();
  std::vector<NumberedTriangle> triangles(count);
  for (std::uint32_t t = 0; t < count; ++t) {
    const auto& [a, b, c] = domain.triangles[t].vertex;
    triangles[t] = {{a, b, c}, t};
  }
  TriangleTree tree;
  if (auto error = tree.build(domain.vertices, std::move(triangles), context))
    return tl::unexpected(std::move(*error));

  const bool is_none = size.constant() == kInfinity;
  std::vector<double> bounds(points.size());
  const auto sample = [&](std::size_t block) {
    const std::size_t first = block * kAtOnce;
    const std::size_t n = std::min(kAtOnce, points.size() - first);
    alignas(64) double x[kAtOnce] = {};
    alignas(64) double y[kAtOnce] = {};
    alignas(64) double area[kAtOnce];
    for (std::size_t i = 0; i < n; ++i) {
      x[i] = points[first + i].x;
      y[i] = points[first + i].y;
    }
    size.evaluate(n, x, y, area);
    for (std::size_t i = 0; i < n; ++i) {
      const auto found = tree.holding({x[i], y[i]});
      double& bound = bounds[first + i];
      if (found.place == kNone) {
        bound = std::numeric_limits<double>::quiet_NaN();
        continue;
      }
      bound =
          domain.regions[domain.triangles[tree.triangles()[found.place].number].region].max_area;
      if (!is_none && !(area[i] > 0 && area[i] < kInfinity))
        bound = 0;
      else if (SizeFunction::bounds_area(area[i]))
        bound = std::min(bound, area[i]);
    }
  };
  const std::size_t blocks = (points.size() + kAtOnce - 1) / kAtOnce;
  if (auto error = polled_loop(context, blocks, sample)) return tl::unexpected(std::move(*error));
  return bounds;
}

}  // namespace weft

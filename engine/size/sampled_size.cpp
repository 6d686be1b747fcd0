// SPDX-License-Identifier: Apache-2.0
#include "engine/size/sampled_size.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "engine/size/fields/polled_loop.h"
#include "engine/size/fields/triangle_tree.h"

namespace weft {
namespace {

constexpr std::size_t kAtOnce = 256;  // points
constexpr int kGrid = 256;            // cells each way
constexpr double kInfinity = std::numeric_limits<double>::infinity();

class Sampler {
 public:
  Sampler(const SizeFunction& size, const Domain& domain, const ExecutionContext& context)
      : size_(size), domain_(domain), context_(context), is_none_(size.constant() == kInfinity) {}

  std::optional<Error> build() {
    const std::size_t count = domain_.triangles.size();
    std::vector<NumberedTriangle> triangles(count);
    for (std::uint32_t t = 0; t < count; ++t) {
      const auto& [a, b, c] = domain_.triangles[t].vertex;
      triangles[t] = {{a, b, c}, t};
    }
    return tree_.build(domain_.vertices, std::move(triangles), context_);
  }

  Result<std::vector<double>> bounds_at(std::span<const Point> points) const {
    std::vector<double> bounds(points.size());
    const std::size_t blocks = (points.size() + kAtOnce - 1) / kAtOnce;
    const auto sample = [&](std::size_t block) {
      const std::size_t first = block * kAtOnce;
      const std::size_t n = std::min(kAtOnce, points.size() - first);
      sample_block(points.subspan(first, n), bounds.data() + first);
    };
    if (auto error = polled_loop(context_, blocks, sample))
      return tl::unexpected(std::move(*error));
    return bounds;
  }

  std::vector<Point> middles_of_cells() const {
    const Box& box = tree_.box();
    const double dx = box.width() / kGrid, dy = box.height() / kGrid;
    std::vector<Point> middles;
    for (int row = 0; row < kGrid; ++row)
      for (int column = 0; column < kGrid; ++column)
        middles.push_back({box.min_x + (column + 0.5) * dx, box.min_y + (row + 0.5) * dy});
    return middles;
  }

  double area_of_cell() const {
    return tree_.box().width() / kGrid * (tree_.box().height() / kGrid);
  }

  // The first point with the bound 0 for which most of the domain around it has none either.
  Result<std::optional<Point>> bad_of(std::span<const Point> points,
                                      const std::vector<double>& bounds) const {
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (bounds[i] != 0) continue;
      const auto around = bounds_at(ring_around(points[i]));
      if (!around) return tl::unexpected(around.error());
      const auto bad = std::count(around->begin(), around->end(), 0.0);
      const auto good =
          std::count_if(around->begin(), around->end(), [](double bound) { return bound > 0; });
      if (bad >= good) return points[i];
    }
    return std::nullopt;
  }

 private:
  // None on a line through p that is along an axis or a diagonal, as borders often are.
  std::vector<Point> ring_around(Point p) const {
    constexpr int kPoints = 8;
    constexpr double kReach = 1e-6;  // of the box
    constexpr double kPi = 3.14159265358979323846;
    const double radius = kReach * std::max(tree_.box().width(), tree_.box().height());
    std::vector<Point> ring;
    for (int k = 0; k < kPoints; ++k) {
      const double angle = (k + 0.3) * (2 * kPi / kPoints);
      ring.push_back({p.x + radius * std::cos(angle), p.y + radius * std::sin(angle)});
    }
    return ring;
  }

  void sample_block(std::span<const Point> points, double* bounds) const {
    alignas(64) double x[kAtOnce] = {};
    alignas(64) double y[kAtOnce] = {};
    alignas(64) double area[kAtOnce];
    for (std::size_t i = 0; i < points.size(); ++i) {
      x[i] = points[i].x;
      y[i] = points[i].y;
    }
    size_.evaluate(points.size(), x, y, area);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto found = tree_.holding(points[i]);
      if (found.place == kNone) {
        bounds[i] = std::numeric_limits<double>::quiet_NaN();
        continue;
      }
      bounds[i] =
          domain_.regions[domain_.triangles[tree_.triangles()[found.place].number].region].max_area;
      if (!is_none_ && !(area[i] > 0 && area[i] < kInfinity))
        bounds[i] = 0;
      else if (SizeFunction::bounds_area(area[i]))
        bounds[i] = std::min(bounds[i], area[i]);
    }
  }

  const SizeFunction& size_;
  const Domain& domain_;
  const ExecutionContext& context_;
  const bool is_none_;
  TriangleTree tree_;
};

}  // namespace

std::uint64_t bytes_to_sample(const Domain& domain, std::size_t points) {
  constexpr std::uint64_t kCells = kGrid * kGrid;
  return TriangleTree::bytes_to_build(domain.triangles.size()) + points * sizeof(double) +
         kCells * (sizeof(Point) + sizeof(double));
}

Result<SampledSize> sample_size(const SizeFunction& size, const Domain& domain,
                                std::span<const Point> points, const ExecutionContext& context) {
  Sampler sampler(size, domain, context);
  if (auto error = sampler.build()) return tl::unexpected(std::move(*error));
  SampledSize sampled;
  const auto sample = [&](std::span<const Point> at) -> Result<std::vector<double>> {
    auto bounds = sampler.bounds_at(at);
    if (!bounds || sampled.bad) return bounds;
    const auto bad = sampler.bad_of(at, *bounds);
    if (!bad) return tl::unexpected(bad.error());
    sampled.bad = *bad;
    return bounds;
  };

  auto bounds = sample(points);
  if (!bounds) return tl::unexpected(bounds.error());
  sampled.bounds = std::move(*bounds);
  const auto of_cells = sample(sampler.middles_of_cells());
  if (!of_cells) return tl::unexpected(of_cells.error());
  for (const double bound : *of_cells)
    if (bound > 0) sampled.per_bound += 1 / bound;
  sampled.per_bound *= sampler.area_of_cell();
  return sampled;
}

}  // namespace weft

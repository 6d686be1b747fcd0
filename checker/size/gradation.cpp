// SPDX-License-Identifier: Apache-2.0
#include "checker/size/gradation.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace weft::check {
namespace {

std::vector<Box> boxes_of(const std::vector<Vec2>& points) {
  std::vector<Box> boxes;
  boxes.reserve(points.size());
  for (const Vec2 p : points) boxes.push_back(box_of(p, p));
  return boxes;
}

}  // namespace

double area_of_edge(double edge) {
  return std::numbers::sqrt3 / 4 * edge * edge;
}

double edge_of_area(double area) {
  return std::sqrt(4 / std::numbers::sqrt3 * area);
}

GradationLimit::GradationLimit(const std::vector<Vec2>& points, const std::vector<double>& areas,
                               double gradation)
    : GradationLimit(
          [&] {
            Samples samples;
            for (std::size_t i = 0; i < points.size(); ++i) {
              if (!(areas[i] >= 0) || std::isinf(areas[i])) continue;
              samples.points.push_back(points[i]);
              samples.edges.push_back(edge_of_area(areas[i]));
            }
            return samples;
          }(),
          gradation) {}

GradationLimit::GradationLimit(Samples samples, double gradation)
    : samples_(std::move(samples)),
      gradation_(gradation),
      tree_(boxes_of(samples_.points), samples_.edges) {}

double GradationLimit::operator()(Vec2 p, double area) const {
  double edge = edge_of_area(area);
  const auto found = tree_.least(p, gradation_, edge, [&](std::uint32_t i) {
    const Vec2 q = samples_.points[i];
    const double dx = p.x - q.x;
    const double dy = p.y - q.y;
    return samples_.edges[i] + gradation_ * std::sqrt(dx * dx + dy * dy);
  });
  return found ? area_of_edge(edge) : area;
}

}  // namespace weft::check

// SPDX-License-Identifier: Apache-2.0
// The limit to the growth of a size. With edges of length h, the largest function below h that
// grows by at most G per unit of length is
//   h_G(p) = min over q in the domain of h(q) + G |p - q|.
// Each sample q of the domain gives an upper bound on it; so a mesh that keeps to h_G keeps to the
// bounds of all samples, whatever made it. Independent of the engine's.
//
//   const GradationLimit limit(centroids, areas, 0.15);
//   double bound = limit(p, size(p));
#pragma once

#include <optional>
#include <vector>

#include "checker/domain.h"
#include "checker/geometry/box_tree.h"

namespace weft::check {

// Of an equilateral triangle, and back.
double area_of_edge(double edge);
double edge_of_area(double area);

class GradationLimit {
 public:
  // `areas`: the bound on areas at each point, squared units. What is not finite, or negative, is
  // no sample. REQUIRES: as many as points; gradation > 0, finite.
  GradationLimit(const std::vector<Vec2>& points, const std::vector<double>& areas,
                 double gradation);

  // The bound on areas at p that the samples give, if it is below `area`; else `area`. Exact but
  // for rounding.
  double operator()(Vec2 p, double area) const;

 private:
  struct Samples {
    std::vector<Vec2> points;
    std::vector<double> edges;
  };
  GradationLimit(Samples samples, double gradation);

  Samples samples_;
  double gradation_;
  BoxTree tree_;
};

}  // namespace weft::check

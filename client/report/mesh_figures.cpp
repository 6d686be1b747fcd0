// SPDX-License-Identifier: Apache-2.0
#include "client/report/mesh_figures.h"

namespace weft::client {

Json figures_json(const MeshFigures& figures) {
  return {{"vertices", figures.vertices},
          {"triangles", figures.triangles},
          {"edges", figures.edges},
          {"area", figures.area},
          {"min_angle_deg", figures.min_angle_deg},
          {"max_angle_deg", figures.max_angle_deg},
          {"min_angle_p1_deg", figures.min_angle_p1_deg},
          {"mean_quality", figures.mean_quality},
          {"ideal_ratio", figures.ideal_ratio}};
}

}  // namespace weft::client

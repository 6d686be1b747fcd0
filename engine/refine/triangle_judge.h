// SPDX-License-Identifier: GPL-3.0-or-later
// The badness of a triangle that no insertion here has made: as a ring of one edge around its first
// vertex.
#pragma once

#include <cstdint>

#include "engine/refine/cavity.h"
#include "engine/refine/mesh.h"
#include "engine/refine/quality_bounds.h"

namespace weft {

// One a thread.
class TriangleJudge {
 public:
  template <class AreaBound>
  Badness operator()(const Mesh& mesh, std::uint32_t t, double region_bound,
                     const QualityBounds& quality, AreaBound& area) {
    const Triangle& triangle = mesh.triangles[t];
    const Point p = mesh.vertices[triangle.vertex[0]];
    ring_.size = 1;
    for (std::uint32_t i = 0; i < 2; ++i) {
      const Point q = mesh.vertices[triangle.vertex[i + 1]];
      ring_.x[i] = q.x - p.x;
      ring_.y[i] = q.y - p.y;
      ring_.length2[i] = ring_.x[i] * ring_.x[i] + ring_.y[i] * ring_.y[i];
    }
    ring_.cross[0] = ring_.x[0] * ring_.y[1] - ring_.y[0] * ring_.x[1];
    Badness badness = kGood;
    area.judge(ring_, 0, 1, p, region_bound, quality, &badness);
    return badness;
  }

 private:
  Ring ring_{1};
};

}  // namespace weft

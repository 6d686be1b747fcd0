// SPDX-License-Identifier: Apache-2.0
// The badness of a triangle that no insertion here has made. It is judged as a ring around its
// first vertex, made of the opposite edge there and back, because rings are judged two triangles at
// a time (quality_bounds.h). Not thread-safe: one per thread.
#pragma once

#include <array>
#include <cstdint>

#include "engine/refine/cavity.h"
#include "engine/refine/quality_bounds.h"
#include "engine/refine/storage/mesh_store.h"

namespace weft {

class TriangleJudge {
 public:
  template <class AreaBound>
  Badness operator()(const MeshStore& mesh, std::uint32_t t, double region_bound,
                     const QualityBounds& quality, AreaBound& area) {
    const auto& v = mesh.triangles[t].vertex;
    return (*this)(mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]], region_bound,
                   quality, area);
  }

  // The badness of the triangle p, q, r, which need not be in a mesh.
  template <class AreaBound>
  Badness operator()(Point p, Point q, Point r, double region_bound, const QualityBounds& quality,
                     AreaBound& area) {
    const Point ends[2] = {q, r};
    ring_.size = 2;
    for (std::uint32_t i = 0; i < 2; ++i) {
      RingPoint& point = ring_.points[i];
      point.x = ends[i].x - p.x;
      point.y = ends[i].y - p.y;
      point.length2 = point.x * point.x + point.y * point.y;
    }
    const RingPoint& a = ring_.points[0];
    RingPoint& b = ring_.points[1];
    b.cross = a.x * b.y - a.y * b.x;
    ring_.points[2] = a;
    ring_.points[2].cross = b.cross;
    std::array<Badness, 2> badness{};
    area.judge(ring_, 0, 2, p, region_bound, quality, badness.data());
    return badness[0];
  }

 private:
  Ring ring_{2};
};

}  // namespace weft

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
    const auto relative = [&](Point at) {
      const double x = at.x - p.x, y = at.y - p.y;
      return RingPoint{x, y, x * x + y * y, 0, 0, 0, 0};
    };
    const RingPoint a = relative(q);
    RingPoint b = relative(r);
    b.cross = a.x * b.y - a.y * b.x;
    Badness badness = kGood;
    (*this)(a, b, p, region_bound, quality, area, badness);
    return badness;
  }

  // The triangle of p and one edge of a ring around it, from a to b.
  template <class AreaBound>
  RingVerdict operator()(const RingPoint& a, const RingPoint& b, Point p, double region_bound,
                         const QualityBounds& quality, AreaBound& area, Badness& badness) {
    ring_.size = 2;
    ring_.points[0] = ring_.points[2] = a;
    ring_.points[1] = b;
    ring_.points[2].cross = b.cross;
    std::array<Badness, 2> both{};
    const RingVerdict verdict = area.judge(ring_, 0, 2, p, region_bound, quality, both.data());
    badness = both[0];
    return verdict;
  }

 private:
  Ring ring_{2};
};

}  // namespace weft

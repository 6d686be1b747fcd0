// SPDX-License-Identifier: Apache-2.0
// Bounds on the areas of triangles, for many at a time: a size is costly to evaluate for one.
//
//   AreaBatch batch;
//   for (...) if (batch.add(mesh, t)) batch.take(area, f);   // it is full
//   batch.take(area, f);   // f(t, twice its area, the bound at its centroid), for each
//
// Units: areas in squared units of the domain. Not thread-safe: one per task.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/base/geometry.h"
#include "engine/refine/storage/mesh_store.h"
#include "engine/size/size_function.h"

namespace weft {

class AreaBatch {
 public:
  // Returns whether it is full: then `take` comes next.
  bool add(const MeshStore& mesh, std::uint32_t t) {
    const auto& v = mesh.triangles[t].vertex;
    const Point a = mesh.vertices[v[0]], b = mesh.vertices[v[1]], c = mesh.vertices[v[2]];
    triangle_[size_] = t;
    doubled_[size_] = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    const Point at = centroid(a, b, c);
    x_[size_] = at.x;
    y_[size_] = at.y;
    return ++size_ == kSize;
  }

  // Calls f for all, in the order in which they came, and forgets them. The bound of their regions
  // is not in the bound.
  template <class AreaBound, class F>
  void take(AreaBound& area, F&& f) {
    if (size_ == 0) return;
    for (std::size_t i = size_; i % SizeFunction::kLanes != 0; ++i) {  // these are evaluated, too
      x_[i] = x_[0];
      y_[i] = y_[0];
    }
    area.bounds_at(size_, x_, y_, bound_);
    for (std::size_t i = 0; i < size_; ++i) f(triangle_[i], doubled_[i], bound_[i]);
    size_ = 0;
  }

 private:
  static constexpr std::size_t kSize = 64;
  static_assert(kSize % SizeFunction::kLanes == 0);

  std::size_t size_ = 0;
  std::uint32_t triangle_[kSize] = {};
  double doubled_[kSize] = {};
  alignas(64) double x_[kSize] = {};  // of the centroids
  alignas(64) double y_[kSize] = {};
  alignas(64) double bound_[kSize] = {};
};

}  // namespace weft

// SPDX-License-Identifier: Apache-2.0
#include "client/drawing/worst_triangles.h"

#include <algorithm>
#include <tuple>

namespace weft::client {
namespace {

bool is_worse(const WorstTriangle& a, const WorstTriangle& b) {
  return std::tie(a.angle_deg, a.triangle.id) < std::tie(b.angle_deg, b.triangle.id);
}

}  // namespace

void WorstTriangles::add(const DrawnTriangle& triangle) {
  if (most_ == 0) return;
  const WorstTriangle one{smallest_angle_deg(triangle, unit_), triangle};
  if (heap_.size() == most_) {
    if (!is_worse(one, heap_.front())) return;
    std::pop_heap(heap_.begin(), heap_.end(), is_worse);
    heap_.pop_back();
  }
  heap_.push_back(one);
  std::push_heap(heap_.begin(), heap_.end(), is_worse);
}

std::vector<WorstTriangle> WorstTriangles::sorted() const {
  std::vector<WorstTriangle> all = heap_;
  std::sort(all.begin(), all.end(), is_worse);
  return all;
}

}  // namespace weft::client

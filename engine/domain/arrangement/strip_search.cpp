// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/arrangement/strip_search.h"

#include <algorithm>
#include <cmath>

namespace weft {

StripSearch::Place StripSearch::place(Vertex v) const {
  const Point p = t_.at(v);
  const double x = p.x - from_.x, y = p.y - from_.y;
  return {along_.x * x + along_.y * y, along_.x * y - along_.y * x};
}

bool StripSearch::is_low(Place p) const {
  return std::fabs(p.above) < height_ * length_;
}

// Whether the strip may pass through the edge.
bool StripSearch::leads_on(Edge edge) const {
  if (t_.constraint(edge) != kNone) return false;
  const Vertex a = t_.right(edge), b = t_.left(edge);
  if (a == Triangulation::kInfinite || b == Triangulation::kInfinite) return false;
  const Place p = place(a), q = place(b);
  // Near an end of the edge the strip is a wedge: the tangent of 30 degrees is 0.577.
  constexpr double kTangent = 0.58;
  if (a == u_ || b == u_) {
    const Place far = a == u_ ? q : p;
    return far.along > 0 && far.above < kTangent * far.along;
  }
  if (a == v_ || b == v_) {
    const Place far = a == v_ ? q : p;
    return far.along < length2_ && far.above < kTangent * (length2_ - far.along);
  }
  if (!is_low(p) && !is_low(q)) return false;
  return std::max(p.along, q.along) > 0 && std::min(p.along, q.along) < length2_;
}

StripSearch::Vertex StripSearch::nearest(Edge edge,
                                         const std::function<bool(Vertex)>& is_asked_for) {
  if (is_clear(edge)) return Triangulation::kInfinite;
  u_ = t_.right(edge);
  v_ = t_.left(edge);
  const Point from = t_.at(u_), to = t_.at(v_);
  from_ = from;
  along_ = {to.x - from.x, to.y - from.y};
  length2_ = along_.x * along_.x + along_.y * along_.y;
  length_ = std::sqrt(length2_);
  Vertex best = Triangulation::kInfinite;
  double best_above = height_ * length_;
  seen_.clear();
  stack_.assign(1, t_.mirror(edge));
  while (!stack_.empty()) {
    poller_.step();
    const Edge across = t_.mirror(stack_.back());
    stack_.pop_back();
    const Vertex w = t_.apex(across);
    if (w == Triangulation::kInfinite || !seen_.insert(across.face).second) continue;
    const Place p = place(w);
    if (p.along > 0 && p.along < length2_ && w != u_ && w != v_ &&
        (std::fabs(p.above) < best_above || (std::fabs(p.above) == best_above && w < best)) &&
        is_asked_for(w)) {
      best = w;
      best_above = std::fabs(p.above);
    }
    for (const Edge next : {Edge{across.face, Triangulation::ccw(across.i)},
                            Edge{across.face, Triangulation::cw(across.i)}})
      if (leads_on(next)) stack_.push_back(next);
  }
  return best;
}

}  // namespace weft

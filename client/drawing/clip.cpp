// SPDX-License-Identifier: Apache-2.0
#include "client/drawing/clip.h"

#include <algorithm>
#include <cmath>

namespace weft::client {

std::optional<std::pair<PagePoint, PagePoint>> clipped(const PageBox& box, PagePoint a,
                                                       PagePoint b) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  if (!std::isfinite(dx) || !std::isfinite(dy)) return std::nullopt;
  double from = 0;
  double to = 1;
  // The segment is inside where t * step <= room.
  const auto keep = [&](double step, double room) {
    if (step == 0) return room >= 0;
    step < 0 ? from = std::max(from, room / step) : to = std::min(to, room / step);
    return from <= to;
  };
  if (!(keep(-dx, a.x - box.left) && keep(dx, box.right - a.x) && keep(-dy, a.y - box.top) &&
        keep(dy, box.bottom - a.y)))
    return std::nullopt;
  const auto at = [&](double t) { return PagePoint{a.x + t * dx, a.y + t * dy}; };
  return std::pair{from > 0 ? at(from) : a, to < 1 ? at(to) : b};
}

template <class Inside>
void ClippedTriangle::cut(const Inside& inside) {
  const std::array<PagePoint, 7> old = corners_;
  const std::size_t sides = std::exchange(count_, 0);
  const auto keep = [this](PagePoint p) {  // rounding could add a corner
    if (count_ < corners_.size()) corners_[count_++] = p;
  };
  for (std::size_t i = 0; i < sides; ++i) {
    const PagePoint& p = old[i];
    const PagePoint& q = old[i + 1 == sides ? 0 : i + 1];
    const double at_p = inside(p);
    const double at_q = inside(q);
    if (at_p >= 0) keep(p);
    if ((at_p >= 0) == (at_q >= 0)) continue;
    const double t = at_p / (at_p - at_q);
    keep({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)});
  }
}

ClippedTriangle::ClippedTriangle(const PageBox& box, const std::array<PagePoint, 3>& corners) {
  std::copy(corners.begin(), corners.end(), corners_.begin());
  if (std::all_of(corners.begin(), corners.end(), [&](PagePoint p) { return box.contains(p); }))
    return;
  cut([&](PagePoint p) { return p.x - box.left; });
  cut([&](PagePoint p) { return box.right - p.x; });
  cut([&](PagePoint p) { return p.y - box.top; });
  cut([&](PagePoint p) { return box.bottom - p.y; });
}

}  // namespace weft::client

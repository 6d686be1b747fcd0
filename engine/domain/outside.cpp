// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/outside.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/domain/face.h"

namespace weft {

OutsideSegments find_outside(const Arrangement& a, const Carving& carving, const Pslg& pslg,
                             StopPoller& poller) {
  const auto stays = [&](std::uint32_t t) { return t != kNone && carving.region[t] != kNone; };
  // The segments of which a piece is outside, and a point on each. Most domains have none.
  std::vector<std::pair<std::uint32_t, Point>> pieces;
  for (std::uint32_t t = 0; t < a.triangles.size(); ++t) {
    poller.step();
    if (stays(t)) continue;
    const Arrangement::Triangle& triangle = a.triangles[t];
    for (int i = 0; i < 3; ++i) {
      if (triangle.constraint[i] == kNone || stays(triangle.neighbor[i])) continue;
      const std::uint32_t segment = a.constraints[triangle.constraint[i]].segment;
      const std::uint32_t end = std::min(triangle.vertex[ccw(i)], triangle.vertex[cw(i)]);
      if (pslg.segments[segment].area == kNone) pieces.push_back({segment, a.vertices[end]});
    }
  }
  if (pieces.empty()) return {};

  std::vector<bool> known(pslg.segments.size(), false);  // to stay in part, or counted
  for (std::uint32_t t = 0; t < a.triangles.size(); ++t) {
    poller.step();
    if (!stays(t)) continue;
    for (const std::uint32_t c : a.triangles[t].constraint)
      if (c != kNone) known[a.constraints[c].segment] = true;
  }
  OutsideSegments outside;
  for (const auto& [segment, at] : pieces) {
    if (known[segment]) continue;
    known[segment] = true;
    if (outside.segments++ > 0 && segment > outside.first) continue;
    outside.first = segment;
    outside.at = at;
  }
  return outside;
}

}  // namespace weft

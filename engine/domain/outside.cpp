// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/outside.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/domain/face.h"

namespace weft {

OutsideSegments find_outside(const Arrangement& a, const Carving& carving, const Pslg& pslg,
                             StopPoller& poller) {
  // Calls visit(segment, triangle, i) for the constraints of all triangles that stay, or of the
  // others.
  const auto for_each_constraint = [&](bool stays, auto&& visit) {
    for (std::size_t t = 0; t < a.triangles.size(); ++t) {
      poller.step();
      if ((carving.region[t] != kNone) != stays) continue;
      for (int i = 0; i < 3; ++i)
        if (const std::uint32_t c = a.triangles[t].constraint[i]; c != kNone)
          visit(a.constraints[c].segment, a.triangles[t], i);
    }
  };
  std::vector<bool> known(pslg.segments.size(), false);  // to stay, or counted
  for_each_constraint(true,
                      [&](std::uint32_t segment, const auto&, int) { known[segment] = true; });
  OutsideSegments outside;
  for_each_constraint(false, [&](std::uint32_t segment, const auto& triangle, int i) {
    if (known[segment] || pslg.segments[segment].area != kNone) return;
    known[segment] = true;
    if (outside.segments++ > 0 && segment > outside.first) return;
    outside.first = segment;
    outside.at = a.vertices[std::min(triangle.vertex[ccw(i)], triangle.vertex[cw(i)])];
  });
  return outside;
}

}  // namespace weft

// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/triangulation/locate.h"

#include <unordered_set>
#include <vector>

#include "engine/domain/arrangement/snapping.h"
#include "engine/domain/triangulation/filtered.h"

namespace weft {
namespace {

// The triangle contains p, boundary included; `side[i]` is p's side of the edge opposite vertex[i].
Location settle(const Arrangement& a, Point p, std::uint32_t triangle, const int (&side)[3]) {
  const Arrangement::Triangle& t = a.triangles[triangle];
  Location location{.triangle = triangle};
  for (int i = 0; i < 3; ++i) {
    if (a.vertices[t.vertex[i]] == p) location.on_vertex = true;
    if (side[i] == 0 && t.constraint[i] != kNone) location.on_segment = true;
  }
  return location;
}

}  // namespace

// The stochastic visibility walk of O. Devillers, S. Pion and M. Teillaud, "Walking in a
// triangulation", 2002: in a constrained triangulation only a random choice among the edges that
// face p keeps a walk from going in circles. The generator is seeded alike in every call.
Location locate(const Arrangement& a, Point p, std::uint32_t start, StopPoller& poller) {
  std::uint32_t random = 2463534242u;  // G. Marsaglia's xorshift
  std::uint32_t triangle = start;
  for (;;) {
    poller.step();
    random ^= random << 13;
    random ^= random >> 17;
    random ^= random << 5;
    const Arrangement::Triangle& t = a.triangles[triangle];
    int side[3];
    for (int i = 0; i < 3; ++i)
      side[i] =
          orientation(a.vertices[t.vertex[(i + 1) % 3]], a.vertices[t.vertex[(i + 2) % 3]], p);
    unsigned tried = 0;
    unsigned i = random % 3;
    while (tried < 3 && side[i] >= 0) {
      ++tried;
      i = (i + 1) % 3;
    }
    if (tried == 3) return settle(a, p, triangle, side);
    if (t.neighbor[i] == kNone) return {};  // the hull is convex
    triangle = t.neighbor[i];
  }
}

// Floods the triangles across edges that are within `radius`, and stops as soon as one of their
// vertices is. So it visits few triangles even beside a vertex of high degree.
bool is_near(const Arrangement& a, Point p, std::uint32_t triangle, double radius,
             StopPoller& poller) {
  std::vector<std::uint32_t> stack{triangle};
  std::unordered_set<std::uint32_t> seen{triangle};
  while (!stack.empty()) {
    poller.step();
    const Arrangement::Triangle& t = a.triangles[stack.back()];
    stack.pop_back();
    for (const std::uint32_t v : t.vertex)
      if (distance(a.vertices[v], p) < radius) return true;
    for (int i = 0; i < 3; ++i) {
      const Point b = a.vertices[t.vertex[(i + 1) % 3]], c = a.vertices[t.vertex[(i + 2) % 3]];
      if (distance_to_segment(p, b, c) >= radius) continue;
      if (t.constraint[i] != kNone) return true;
      if (t.neighbor[i] != kNone && seen.insert(t.neighbor[i]).second)
        stack.push_back(t.neighbor[i]);
    }
  }
  return false;
}

}  // namespace weft

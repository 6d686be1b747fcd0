// SPDX-License-Identifier: Apache-2.0
#include "client/formats/domains/ring_crossing.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <set>
#include <vector>

#include "client/formats/derived/orientation.h"

namespace weft::client {
namespace {

bool before(Point a, Point b) {
  return a.x < b.x || (a.x == b.x && a.y < b.y);
}

struct Edge {
  Point left;
  Point right;
};

bool interiors_cross(const Edge& s, const Edge& t) {
  return orientation(s.left, s.right, t.left) * orientation(s.left, s.right, t.right) < 0 &&
         orientation(t.left, t.right, s.left) * orientation(t.left, t.right, s.right) < 0;
}

// The order of edges along the sweep line; collinear edges are ordered by index. It is consistent
// up to the first crossing, and there the sweep ends.
struct Below {
  const std::vector<Edge>* edges;
  bool operator()(std::uint32_t i, std::uint32_t j) const {
    const Edge& s = (*edges)[i];
    const Edge& t = (*edges)[j];
    if (i == j) return false;
    if (before(t.left, s.left)) {
      const int side = orientation(t.left, t.right, s.left);
      if (side != 0) return side < 0;
      const int end = orientation(t.left, t.right, s.right);
      return end != 0 ? end < 0 : i < j;
    }
    const int side = orientation(s.left, s.right, t.left);
    if (side != 0) return side > 0;
    const int end = orientation(s.left, s.right, t.right);
    return end != 0 ? end > 0 : i < j;
  }
};

}  // namespace

std::optional<std::pair<std::uint32_t, std::uint32_t>> find_crossing(std::span<const Point> ring) {
  const std::size_t n = ring.size();
  std::vector<Edge> edges(n);
  struct Event {
    Point at;
    bool starts;
    std::uint32_t edge;
  };
  std::vector<Event> events;
  events.reserve(2 * n);
  for (std::uint32_t i = 0; i < n; ++i) {
    const Point a = ring[i];
    const Point b = ring[i + 1 < n ? i + 1 : 0];
    edges[i] = before(a, b) ? Edge{a, b} : Edge{b, a};
    events.push_back({edges[i].left, true, i});
    events.push_back({edges[i].right, false, i});
  }
  std::sort(events.begin(), events.end(), [](const Event& a, const Event& b) {
    if (a.at != b.at) return before(a.at, b.at);
    if (a.starts != b.starts) return b.starts;  // edges that end here are removed first
    return a.edge < b.edge;
  });

  using Status = std::set<std::uint32_t, Below>;
  Status status(Below{&edges});
  std::vector<Status::iterator> position(n, status.end());
  const auto crossing =
      [&edges](std::uint32_t i,
               std::uint32_t j) -> std::optional<std::pair<std::uint32_t, std::uint32_t>> {
    if (!interiors_cross(edges[i], edges[j])) return std::nullopt;
    return std::pair{std::min(i, j), std::max(i, j)};
  };
  for (const Event& event : events) {
    if (event.starts) {
      const auto [here, inserted] = status.insert(event.edge);
      if (!inserted) continue;  // only if coordinates overflow the predicates
      position[event.edge] = here;
      if (here != status.begin())
        if (const auto found = crossing(*std::prev(here), event.edge)) return found;
      if (std::next(here) != status.end())
        if (const auto found = crossing(event.edge, *std::next(here))) return found;
    } else if (const auto here = position[event.edge]; here != status.end()) {
      const auto above = status.erase(here);
      if (above != status.begin() && above != status.end())
        if (const auto found = crossing(*std::prev(above), *above)) return found;
    }
  }
  return std::nullopt;
}

}  // namespace weft::client

// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/ring_crossing.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <set>
#include <vector>

#include "files/formats/derived/orientation.h"

namespace weft::files {
namespace {

bool before(Point a, Point b) {
  return a.x < b.x || (a.x == b.x && a.y < b.y);
}

struct Edge {
  Point left;
  Point right;
  int turn = 0;  // what the winding number gains from below the edge to above it
};

bool interiors_cross(const Edge& s, const Edge& t) {
  return orientation(s.left, s.right, t.left) * orientation(s.left, s.right, t.right) < 0 &&
         orientation(t.left, t.right, s.left) * orientation(t.left, t.right, s.right) < 0;
}

bool is_on_one_line(const Edge& s, const Edge& t) {
  return orientation(s.left, s.right, t.left) == 0 && orientation(s.left, s.right, t.right) == 0;
}

// The order of edges along the sweep line; of collinear edges, those that come later are above. It
// is consistent up to the first crossing, and there the sweep ends.
struct Below {
  const std::vector<Edge>* edges;
  const std::vector<std::uint32_t>* ranks;  // in the order in which edges come
  bool operator()(std::uint32_t i, std::uint32_t j) const {
    const Edge& s = (*edges)[i];
    const Edge& t = (*edges)[j];
    if (i == j) return false;
    if (before(t.left, s.left)) {
      const int side = orientation(t.left, t.right, s.left);
      if (side != 0) return side < 0;
      const int end = orientation(t.left, t.right, s.right);
      return end != 0 ? end < 0 : (*ranks)[i] < (*ranks)[j];
    }
    const int side = orientation(s.left, s.right, t.left);
    if (side != 0) return side > 0;
    const int end = orientation(s.left, s.right, t.right);
    return end != 0 ? end > 0 : (*ranks)[i] < (*ranks)[j];
  }
};

class Sweep {
 public:
  struct Fault {
    std::uint32_t edge = 0;
    std::optional<std::uint32_t> crossed;  // another edge, if the two cross
    Point at;
  };

  explicit Sweep(std::vector<Edge> edges)
      : edges_(std::move(edges)),
        ranks_(edges_.size()),
        windings_(edges_.size()),
        status_(Below{&edges_, &ranks_}),
        position_(edges_.size(), status_.end()) {
    events_.reserve(2 * edges_.size());
    for (std::uint32_t i = 0; i < edges_.size(); ++i) {
      events_.push_back({edges_[i].left, true, i});
      events_.push_back({edges_[i].right, false, i});
    }
    std::sort(events_.begin(), events_.end(), [](const Event& a, const Event& b) {
      if (a.at != b.at) return before(a.at, b.at);
      if (a.starts != b.starts) return b.starts;  // edges that end here are removed first
      return a.edge < b.edge;
    });
  }

  // The first crossing; if `by_winding`, or the first place of a winding number other than 0 and 1.
  std::optional<Fault> find(bool by_winding) {
    for (std::size_t first = 0; first < events_.size();) {
      std::size_t end = first;
      Status::iterator here = status_.end();  // an edge at the point, or the one above it
      for (; end < events_.size() && events_[end].at == events_[first].at; ++end)
        if (auto found = events_[end].starts ? start(events_[end].edge, here)
                                             : stop(events_[end].edge, here))
          return found;
      if (by_winding)
        if (auto found = wind(events_[first].at, here)) return found;
      first = end;
    }
    return std::nullopt;
  }

 private:
  using Status = std::set<std::uint32_t, Below>;
  struct Event {
    Point at;
    bool starts;
    std::uint32_t edge;
  };

  std::optional<Fault> crossing(std::uint32_t i, std::uint32_t j) const {
    if (!interiors_cross(edges_[i], edges_[j])) return std::nullopt;
    return Fault{std::max(i, j), std::min(i, j), edges_[std::max(i, j)].left};
  }

  std::optional<Fault> start(std::uint32_t edge, Status::iterator& at) {
    ranks_[edge] = ++count_;
    const auto [here, inserted] = status_.insert(edge);
    if (!inserted) return std::nullopt;  // only if coordinates overflow the predicates
    position_[edge] = at = here;
    if (here != status_.begin())
      if (auto found = crossing(*std::prev(here), edge)) return found;
    if (std::next(here) != status_.end()) return crossing(edge, *std::next(here));
    return std::nullopt;
  }

  std::optional<Fault> stop(std::uint32_t edge, Status::iterator& at) {
    const auto here = position_[edge];
    if (here == status_.end()) return std::nullopt;
    const auto above = status_.erase(here);
    at = above;
    if (above == status_.begin() || above == status_.end()) return std::nullopt;
    return crossing(*std::prev(above), *above);
  }

  bool is_on(Point p, std::uint32_t edge) const {
    return orientation(edges_[edge].left, edges_[edge].right, p) == 0;
  }

  // Sets the winding numbers above the edges through a point, once all that end there are gone and
  // all that start there have come.
  std::optional<Fault> wind(Point p, Status::iterator here) {
    while (here != status_.begin() && is_on(p, *std::prev(here))) --here;
    int winding = here == status_.begin() ? 0 : windings_[*std::prev(here)];
    for (; here != status_.end() && is_on(p, *here); ++here) {
      windings_[*here] = winding += edges_[*here].turn;
      const auto above = std::next(here);
      const bool has_room =
          above == status_.end() || !is_on_one_line(edges_[*here], edges_[*above]);
      if (has_room && winding != 0 && winding != 1) return Fault{*here, std::nullopt, p};
    }
    return std::nullopt;
  }

  std::vector<Edge> edges_;
  std::vector<std::uint32_t> ranks_;
  std::vector<int> windings_;  // above each edge of the status
  std::vector<Event> events_;
  Status status_;
  std::vector<Status::iterator> position_;
  std::uint32_t count_ = 0;
};

// `turn`: of edges that run to the right.
void add_edges(std::span<const Point> ring, int turn, std::vector<Edge>& edges) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point a = ring[i];
    const Point b = ring[i + 1 < ring.size() ? i + 1 : 0];
    edges.push_back(before(a, b) ? Edge{a, b, turn} : Edge{b, a, -turn});
  }
}

bool is_counter_clockwise(std::span<const Point> ring) {
  double doubled_area = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i)
    doubled_area += (ring[i].x - ring[0].x) * (ring[i + 1].y - ring[0].y) -
                    (ring[i + 1].x - ring[0].x) * (ring[i].y - ring[0].y);
  return doubled_area > 0;
}

// A ring that nothing is to the left of, which is no hole.
std::span<const Point> leftmost(std::span<const std::span<const Point>> rings) {
  const auto left = [](std::span<const Point> ring) {
    return *std::min_element(ring.begin(), ring.end(), before);
  };
  return *std::min_element(rings.begin(), rings.end(), [&left](const auto& a, const auto& b) {
    return before(left(a), left(b));
  });
}

}  // namespace

std::optional<std::pair<std::uint32_t, std::uint32_t>> find_crossing(std::span<const Point> ring) {
  std::vector<Edge> edges;
  edges.reserve(ring.size());
  add_edges(ring, 0, edges);
  const auto found = Sweep(std::move(edges)).find(false);
  if (!found) return std::nullopt;
  return std::pair{*found->crossed, found->edge};
}

std::optional<RingOverlap> find_overlap(std::span<const std::span<const Point>> rings,
                                        RingRoles roles) {
  std::vector<Edge> edges;
  std::vector<std::size_t> ends;  // of the edges of each ring
  const bool outer_way = is_counter_clockwise(leftmost(rings));
  for (std::size_t r = 0; r < rings.size(); ++r) {
    // So that the polygon has the winding number 1, and all else 0.
    const bool as_it_is =
        roles == RingRoles::kByDirection ? outer_way : is_counter_clockwise(rings[r]) == (r == 0);
    add_edges(rings[r], as_it_is ? 1 : -1, edges);
    ends.push_back(edges.size());
  }
  const auto found = Sweep(std::move(edges)).find(roles != RingRoles::kByPlace);
  if (!found) return std::nullopt;
  const auto ring_of = [&ends](std::uint32_t edge) {
    return static_cast<std::uint32_t>(std::upper_bound(ends.begin(), ends.end(), edge) -
                                      ends.begin());
  };
  RingOverlap overlap{ring_of(found->edge), std::nullopt, found->at};
  if (found->crossed) overlap.crossed = ring_of(*found->crossed);
  return overlap;
}

}  // namespace weft::files

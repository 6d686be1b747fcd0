// SPDX-License-Identifier: Apache-2.0
#include "checker/domain/fill.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numeric>
#include <optional>
#include <span>

#include "checker/domain/cover.h"
#include "checker/domain/slivers.h"
#include "checker/text.h"

namespace weft::check {
namespace {

// The number of segments that a path from the unbounded face to each other face must cross.
class EvenOdd {
 public:
  EvenOdd(const BentDomain& bent, const Arrangement& arrangement)
      : bent_(bent),
        arrangement_(arrangement),
        first_(arrangement.faces().size() + 1, 0),
        is_sliver_(find_slivers(bent, arrangement)) {
    const auto half_edges = static_cast<std::uint32_t>(2 * arrangement.edges().size());
    for (std::uint32_t h = 0; h < half_edges; ++h) ++first_[arrangement.face(h) + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    around_.resize(half_edges);
    std::vector<std::uint32_t> next = first_;
    for (std::uint32_t h = 0; h < half_edges; ++h) around_[next[arrangement.face(h)]++] = h;
  }

  // Whether all paths to a face cross an even number of segments, or all an odd number: an even
  // number of edges meets at every vertex.
  bool is_closed() const {
    for (std::uint32_t v = 0; v < arrangement_.vertices().size(); ++v) {
      std::uint32_t parity = 0;
      for (const std::uint32_t h : arrangement_.half_edges_at(v)) parity ^= parity_of(h);
      if (parity != 0) return false;
    }
    return true;
  }

  // Per face; kUnreached for some slivers. Where merging has closed a sliver, one edge is left, and
  // an even number of segments on it is no obstacle. So parities count within slivers, and the
  // price is paid when a path leaves one. No path leads across a link, because the mesh has no gap
  // there.
  std::vector<std::uint32_t> through_slivers() const {
    std::vector<std::uint32_t> depth(2 * arrangement_.faces().size(), kUnreached);
    search(depth, [&](std::uint32_t place, std::uint32_t h) {
      const std::uint32_t beyond = arrangement_.face(h ^ 1u);
      const std::uint32_t parity = (place & 1u) ^ parity_of(h);
      if (arrangement_.covers(h / 2).empty()) return Move{place, 0};
      return is_sliver_[beyond] ? Move{2 * beyond + parity, 0} : Move{2 * beyond, parity};
    });
    std::vector<std::uint32_t> result(arrangement_.faces().size());
    for (std::size_t f = 0; f < result.size(); ++f)
      result[f] = std::min(depth[2 * f], depth[2 * f + 1]);
    return result;
  }

  // Per face; kUnreached if every path crosses a sliver, or a link, or an edge as short as one.
  std::vector<std::uint32_t> around_slivers() const {
    std::vector<std::uint32_t> depth(2 * arrangement_.faces().size(), kUnreached);
    search(depth, [&](std::uint32_t place, std::uint32_t h) {
      const std::uint32_t beyond = arrangement_.face(h ^ 1u);
      return is_sliver_[beyond] || is_short(h) ? Move{place, 0} : Move{2 * beyond, parity_of(h)};
    });
    std::vector<std::uint32_t> result(arrangement_.faces().size());
    for (std::size_t f = 0; f < result.size(); ++f) result[f] = depth[2 * f];
    return result;
  }

  static constexpr auto kUnreached = std::numeric_limits<std::uint32_t>::max();

 private:
  struct Move {
    std::uint32_t place;  // twice the face, plus a parity
    std::uint32_t price;  // 0 or 1
  };

  std::uint32_t parity_of(std::uint32_t h) const {
    return static_cast<std::uint32_t>(arrangement_.covers(h / 2).size() % 2);
  }

  bool is_short(std::uint32_t h) const {
    const auto covers = arrangement_.covers(h / 2);
    const Arrangement::Edge& edge = arrangement_.edges()[h / 2];
    const Vec2 p = arrangement_.vertices().at(edge.u), q = arrangement_.vertices().at(edge.v);
    return covers.empty() || std::hypot(q.x - p.x, q.y - p.y) <= 2 * bent_.slack_of(covers);
  }

  // The least prices of all places. move(place, h) is the place to which the half-edge h leads.
  template <class F>
  void search(std::vector<std::uint32_t>& least, F&& move) const {
    std::vector<char> done(least.size(), 0);
    std::deque<std::uint32_t> queue = {0};
    least[0] = 0;
    while (!queue.empty()) {
      const std::uint32_t place = queue.front();
      queue.pop_front();
      if (done[place]) continue;
      done[place] = 1;
      for (std::uint32_t k = first_[place / 2]; k < first_[place / 2 + 1]; ++k) {
        const Move to = move(place, around_[k]);
        if (least[place] + to.price >= least[to.place]) continue;
        least[to.place] = least[place] + to.price;
        if (to.price == 0)
          queue.push_front(to.place);
        else
          queue.push_back(to.place);
      }
    }
  }

  const BentDomain& bent_;
  const Arrangement& arrangement_;
  std::vector<std::uint32_t> first_;   // per face: its first half-edge in around_
  std::vector<std::uint32_t> around_;  // half-edges, by face
  std::vector<char> is_sliver_;        // per face
};

std::vector<FaceRole> fill_even_odd(const BentDomain& bent, const Arrangement& arrangement) {
  const EvenOdd even_odd(bent, arrangement);
  const std::vector<std::uint32_t> least = even_odd.through_slivers();
  std::vector<FaceRole> roles(least.size());
  for (std::size_t f = 1; f < roles.size(); ++f) roles[f].kept = least[f] % 2 == 1;
  if (even_odd.is_closed()) return roles;
  const std::vector<std::uint32_t> most = even_odd.around_slivers();
  for (std::size_t f = 1; f < roles.size(); ++f) roles[f].open = least[f] != most[f];
  return roles;
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// What the areas that cover a face, ascending, make of it. `size`: of each area.
FaceRole role_of(const Domain& domain, std::span<const std::uint32_t> covering,
                 std::span<const double> size) {
  FaceRole role;
  std::size_t areas = 0;
  bool is_hole = false;
  std::optional<std::uint32_t> first;
  const auto comes_before = [&](std::uint32_t a, std::uint32_t b) {
    if (domain.areas[a].priority != domain.areas[b].priority)
      return domain.areas[a].priority > domain.areas[b].priority;
    return size[a] < size[b];
  };
  role.max_area = kInfinity;
  for (const std::uint32_t a : covering) {
    const Area& area = domain.areas[a];
    is_hole = is_hole || area.is_hole;
    if (area.is_hole) continue;
    ++areas;
    role.max_area = std::min(role.max_area, area.max_area.value_or(kInfinity));
    if (area.region && (!first || comes_before(a, *first))) first = a;
  }
  role.kept = !is_hole && (domain.fill == Fill::kSeeds ||
                           (domain.fill == Fill::kUnion ? areas > 0 : areas % 2 == 1));
  if (!first) return role;
  role.region = *domain.areas[*first].region;
  for (const std::uint32_t a : covering) {
    const Area& area = domain.areas[a];
    if (area.is_hole || !area.region || area.priority != domain.areas[*first].priority) continue;
    role.is_region_open = role.is_region_open ||
                          (size[a] != size[*first] && size[a] - size[*first] <= 4e-9 * size[a]);
  }
  return role;
}

// Up to the arcs whose chords bound a face.
std::vector<double> sizes_of_faces(const BentDomain& bent, const Arrangement& arrangement) {
  std::vector<double> sizes;
  for (const Arrangement::Face& face : arrangement.faces()) sizes.push_back(face.area);
  if (bent.beside_arc.empty()) return sizes;
  for (std::uint32_t e = 0; e < arrangement.edges().size(); ++e) {
    if (arrangement.covers(e).empty()) continue;
    const std::uint32_t piece = arrangement.covers(e)[0];
    const auto [a, b] = bent.domain.segments[piece];
    const Vec2 p = bent.domain.points[a], q = bent.domain.points[b];
    const Arrangement::Edge& edge = arrangement.edges()[e];
    const Vec2 u = arrangement.vertices().at(edge.u), v = arrangement.vertices().at(edge.v);
    const double share = ((v.x - u.x) * (q.x - p.x) + (v.y - u.y) * (q.y - p.y)) /
                         ((q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y));
    sizes[arrangement.face(2 * e)] += share * bent.beside_arc[piece];
    sizes[arrangement.face(2 * e + 1)] -= share * bent.beside_arc[piece];
  }
  return sizes;
}

std::vector<FaceRole> fill_by_areas(const BentDomain& bent, const Arrangement& arrangement) {
  const auto covering = covering_areas(bent, arrangement);
  const std::vector<double> size_of_face = sizes_of_faces(bent, arrangement);
  std::vector<double> size(bent.domain.areas.size(), 0.0);
  for (std::size_t f = 1; f < covering.size(); ++f)
    for (const std::uint32_t a : covering[f]) size[a] += size_of_face[f];
  // What rounding alone tells apart is of one size.
  for (double& each : size) {
    int exponent = 0;
    each = std::frexp(each, &exponent);
    each = std::ldexp(std::nearbyint(each * 0x1p30), exponent - 30);
  }
  std::vector<FaceRole> roles;
  for (const auto& areas : covering) roles.push_back(role_of(bent.domain, areas, size));
  return roles;
}

}  // namespace

std::vector<FaceRole> fill_faces(const BentDomain& bent, const Arrangement& arrangement,
                                 Findings& findings) {
  const Domain& domain = bent.domain;
  std::vector<FaceRole> roles;
  if (!domain.areas.empty())
    roles = fill_by_areas(bent, arrangement);
  else if (domain.fill == Fill::kEvenOdd)
    roles = fill_even_odd(bent, arrangement);
  else
    roles.assign(arrangement.faces().size(), {.kept = domain.fill == Fill::kSeeds});
  roles[0].kept = false;
  const auto face_at = [&](std::string_view kind, std::size_t i, Vec2 seed) -> FaceRole* {
    const Arrangement::Place place = arrangement.locate(seed);
    if (!place.edge) return &roles[place.face];
    findings.add(Rule::kDomain, [&] {
      const auto covers = arrangement.covers(*place.edge);
      return say(kind, " seed ", i, " at ", seed, " lies on ",
                 covers.empty() ? "the end of a segment" : say("segment ", bent.given[covers[0]]),
                 ": its face is ambiguous");
    });
    return nullptr;
  };
  const std::vector<FaceRole> without_seeds = roles;
  for (std::size_t i = 0; i < domain.holes.size(); ++i)
    if (FaceRole* role = face_at("hole", i, domain.holes[i])) role->kept = role->open = false;
  for (std::size_t i = 0; i < domain.regions.size(); ++i) {
    const RegionSeed& seed = domain.regions[i];
    FaceRole* role = face_at("region", i, seed.at);
    if (role == nullptr) continue;
    role->region = seed.id;
    role->is_region_open = false;
    const double of_areas = without_seeds[static_cast<std::size_t>(role - roles.data())].max_area;
    role->max_area = std::min(seed.max_area.value_or(kInfinity), of_areas);
  }
  return roles;
}

}  // namespace weft::check

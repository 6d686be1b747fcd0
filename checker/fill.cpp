// SPDX-License-Identifier: Apache-2.0
#include "checker/fill.h"

#include <deque>
#include <limits>
#include <numeric>

#include "checker/text.h"

namespace weft::check {
namespace {

// For each face, how many segments a path from the unbounded face must cross at least; two that
// coincide are no obstacle.
std::vector<std::uint32_t> depths(const Arrangement& arrangement) {
  const auto half_edges = static_cast<std::uint32_t>(2 * arrangement.edges().size());
  std::vector<std::uint32_t> first(arrangement.faces().size() + 1, 0);
  for (std::uint32_t h = 0; h < half_edges; ++h) ++first[arrangement.face(h) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::uint32_t> around(half_edges);
  std::vector<std::uint32_t> next = first;
  for (std::uint32_t h = 0; h < half_edges; ++h) around[next[arrangement.face(h)]++] = h;

  constexpr auto kUnreached = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> depth(arrangement.faces().size(), kUnreached);
  std::vector<char> done(arrangement.faces().size(), 0);
  std::deque<std::uint32_t> queue = {0};
  depth[0] = 0;
  while (!queue.empty()) {
    const std::uint32_t face = queue.front();
    queue.pop_front();
    if (done[face]) continue;
    done[face] = 1;
    for (std::uint32_t k = first[face]; k < first[face + 1]; ++k) {
      const std::uint32_t beyond = arrangement.face(around[k] ^ 1u);
      const auto step = static_cast<std::uint32_t>(arrangement.covers(around[k] / 2).size() % 2);
      if (depth[face] + step >= depth[beyond]) continue;
      depth[beyond] = depth[face] + step;
      if (step == 0)
        queue.push_front(beyond);
      else
        queue.push_back(beyond);
    }
  }
  return depth;
}

}  // namespace

std::vector<FaceRole> fill_faces(const Domain& domain, const Arrangement& arrangement,
                                 Findings& findings) {
  std::vector<FaceRole> roles(arrangement.faces().size());
  if (domain.fill == Fill::kSeeds) {
    for (std::size_t f = 1; f < roles.size(); ++f) roles[f].kept = true;
  } else {
    const std::vector<std::uint32_t> depth = depths(arrangement);
    for (std::size_t f = 1; f < roles.size(); ++f) roles[f].kept = depth[f] % 2 == 1;
  }
  const auto face_at = [&](std::string_view kind, std::size_t i, Vec2 seed) -> FaceRole* {
    const Arrangement::Place place = arrangement.locate(seed);
    if (!place.edge) return &roles[place.face];
    findings.add(Rule::kDomain, [&] {
      const auto covers = arrangement.covers(*place.edge);
      return say(kind, " seed ", i, " at ", seed, " lies on ",
                 covers.empty() ? "the end of a segment" : say("segment ", covers[0]),
                 ": its face is ambiguous");
    });
    return nullptr;
  };
  for (std::size_t i = 0; i < domain.holes.size(); ++i)
    if (FaceRole* role = face_at("hole", i, domain.holes[i])) role->kept = false;
  for (std::size_t i = 0; i < domain.regions.size(); ++i) {
    const RegionSeed& seed = domain.regions[i];
    FaceRole* role = face_at("region", i, seed.at);
    if (role == nullptr) continue;
    role->region = seed.id;
    role->max_area = seed.max_area.value_or(std::numeric_limits<double>::infinity());
  }
  return roles;
}

}  // namespace weft::check

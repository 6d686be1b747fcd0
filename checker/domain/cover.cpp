// SPDX-License-Identifier: Apache-2.0
#include "checker/domain/cover.h"

#include <algorithm>
#include <iterator>
#include <numeric>

namespace weft::check {
namespace {

// The areas that a step across the edge leaves or enters, ascending.
std::vector<std::uint32_t> borders_on(const BentDomain& bent, const Arrangement& arrangement,
                                      std::uint32_t edge) {
  std::vector<std::uint32_t> all;
  if (bent.domain.segment_areas.empty()) return all;
  for (const std::uint32_t piece : arrangement.covers(edge))
    if (const std::uint32_t area = bent.domain.segment_areas[piece]; area != 0)
      all.push_back(area - 1);
  std::sort(all.begin(), all.end());
  std::vector<std::uint32_t> odd;
  for (std::size_t i = 0, end = 0; i < all.size(); i = end) {
    while (end < all.size() && all[end] == all[i]) ++end;
    if ((end - i) % 2 == 1) odd.push_back(all[i]);
  }
  return odd;
}

}  // namespace

std::vector<std::vector<std::uint32_t>> covering_areas(const BentDomain& bent,
                                                       const Arrangement& arrangement) {
  const std::size_t faces = arrangement.faces().size();
  const auto half_edges = static_cast<std::uint32_t>(2 * arrangement.edges().size());
  std::vector<std::uint32_t> by_face(half_edges);
  std::iota(by_face.begin(), by_face.end(), 0u);
  std::stable_sort(by_face.begin(), by_face.end(), [&](std::uint32_t g, std::uint32_t h) {
    return arrangement.face(g) < arrangement.face(h);
  });
  std::vector<std::vector<std::uint32_t>> result(faces);
  std::vector<char> reached(faces, 0);
  std::vector<std::uint32_t> open = {0};
  reached[0] = 1;
  while (!open.empty()) {
    const std::uint32_t face = open.back();
    open.pop_back();
    auto h = std::partition_point(by_face.begin(), by_face.end(),
                                  [&](std::uint32_t g) { return arrangement.face(g) < face; });
    for (; h != by_face.end() && arrangement.face(*h) == face; ++h) {
      const std::uint32_t beyond = arrangement.face(*h ^ 1u);
      if (reached[beyond]) continue;
      reached[beyond] = 1;
      const std::vector<std::uint32_t> borders = borders_on(bent, arrangement, *h / 2);
      std::set_symmetric_difference(result[face].begin(), result[face].end(), borders.begin(),
                                    borders.end(), std::back_inserter(result[beyond]));
      open.push_back(beyond);
    }
  }
  return result;
}

}  // namespace weft::check

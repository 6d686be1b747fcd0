// SPDX-License-Identifier: Apache-2.0
#include "checker/edges/half_edges.h"

#include <algorithm>
#include <numeric>

#include "checker/text.h"

namespace weft::check {

HalfEdges::HalfEdges(const Mesh& mesh)
    : mesh_(mesh),
      first_(mesh.vertices.size() + 1, 0),
      entries_(3 * mesh.triangles.size()),
      twin_(3 * mesh.triangles.size(), kNoTwin) {
  for (std::uint32_t h = 0; h < size(); ++h) ++first_[std::min(start(h), end(h)) + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<std::uint32_t> next = first_;
  for (std::uint32_t h = 0; h < size(); ++h) {
    entries_[next[std::min(start(h), end(h))]++] = {std::max(start(h), end(h)), h};
  }
  for (std::size_t v = 0; v + 1 < first_.size(); ++v)
    std::sort(entries_.begin() + first_[v], entries_.begin() + first_[v + 1]);
}

bool HalfEdges::judge_conformity(Findings& findings) {
  const auto triangles = [&](std::size_t k, std::size_t end) {
    std::string list;
    for (std::size_t i = k; i < std::min(end, k + 4); ++i)
      list += say(i == k ? "" : ", ", entries_[i].half_edge / 3);
    return list + (end - k > 4 ? ", ..." : "");
  };
  for (std::uint32_t low = 0; low + 1 < first_.size(); ++low) {
    for (std::size_t k = first_[low], end = k; k < first_[low + 1]; k = end) {
      while (end < first_[low + 1] && entries_[end].high == entries_[k].high) ++end;
      if (end - k == 1) continue;
      const std::uint32_t h = entries_[k].half_edge;
      const std::uint32_t g = entries_[k + 1].half_edge;
      if (end - k == 2 && start(h) != start(g)) {
        twin_[h] = g;
        twin_[g] = h;
        continue;
      }
      findings.add(Rule::kConformity, [&] {
        return say("edge (", low, ", ", entries_[k].high, ") has ", end - k, " triangles (",
                   triangles(k, end), ")", end - k == 2 ? " on the same side" : "");
      });
    }
  }
  return findings.total(Rule::kConformity) == 0;
}

std::optional<std::uint32_t> HalfEdges::find(std::uint32_t a, std::uint32_t b) const {
  const std::uint32_t low = std::min(a, b), high = std::max(a, b);
  const auto begin = entries_.begin() + first_[low];
  const auto end = entries_.begin() + first_[low + 1];
  const auto found = std::lower_bound(begin, end, Entry{high, 0});
  if (found == end || found->high != high) return std::nullopt;
  return found->half_edge;
}

}  // namespace weft::check

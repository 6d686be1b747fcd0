// SPDX-License-Identifier: Apache-2.0
#include "files/formats/meshes/msh_group_losses.h"

#include <algorithm>
#include <array>

#include "files/base/text.h"

namespace weft::files {
namespace {

// Removes the elements that repeat an earlier one of another group, and calls lose(lost, kept).
template <std::size_t kCorners, class Lose>
void remove(std::vector<std::uint32_t>& corners, std::vector<std::int32_t>& ids,
            std::vector<std::int32_t>& groups, const Lose& lose) {
  using Key = std::array<std::uint32_t, kCorners>;
  std::map<Key, std::int32_t> group_of;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    Key key;
    std::copy_n(&corners[kCorners * i], kCorners, key.begin());
    std::sort(key.begin(), key.end());
    const auto [first, is_new] = group_of.emplace(key, groups[i]);
    if (!is_new && first->second != groups[i]) {
      lose(groups[i], first->second);
      continue;
    }
    std::copy_n(&corners[kCorners * i], kCorners, &corners[kCorners * kept]);
    ids[kept] = ids[i];
    groups[kept++] = groups[i];
  }
  corners.resize(kCorners * kept);
  ids.resize(kept);
  groups.resize(kept);
}

}  // namespace

void MshGroupLosses::lose(Group lost, Group kept, std::size_t elements) {
  Loss& loss = lost_[lost];
  if (loss.elements == 0) loss.kept = kept;
  loss.elements += elements;
}

void MshGroupLosses::keep(const MshGroups& groups) {
  for (const std::int32_t group : groups.of_edges) kept_.insert({1, group});
  for (const auto* list : {&groups.of_triangles, &groups.of_faces})
    for (const std::int32_t group : *list) kept_.insert({2, group});
}

void MshGroupLosses::remove_repeated(Mesh& mesh, MshGroups& groups) {
  const auto lose_surface = [this](std::int32_t lost, std::int32_t kept) {
    lose({2, lost}, {2, kept}, 1);
  };
  remove<2>(mesh.edges, mesh.edge_markers, groups.of_edges,
            [this](std::int32_t lost, std::int32_t kept) {
              lose({1, lost}, {1, kept}, 1);
            });
  remove<3>(mesh.triangles, mesh.regions, groups.of_triangles, lose_surface);
  remove<4>(mesh.faces.corners, mesh.faces.regions, groups.of_faces, lose_surface);
  mesh.faces.ends.resize(groups.of_faces.size());
}

std::string MshGroupLosses::called(Group group) const {
  constexpr const char* kKinds[] = {"point", "curve", "surface", "volume"};
  const auto name = names_.find(group);
  return std::string("physical ") + kKinds[std::clamp(group.first, 0, 3)] + " " +
         std::to_string(group.second) + (name == names_.end() ? "" : " " + in_quotes(name->second));
}

std::vector<std::string> MshGroupLosses::sentences() const {
  std::vector<std::string> all;
  for (const auto& [group, loss] : lost_) {
    const std::string noun = group.first == 1 ? "edge" : "face";
    all.push_back(with_separators(loss.elements) + " " + noun +
                  (loss.elements == 1 ? " of the " : "s of the ") + called(group) +
                  (loss.elements == 1 ? " is" : " are") + " in the " + called(loss.kept) +
                  ", too; the first group counts" +
                  (kept_.contains(group) ? "" : ", so nothing carries this one"));
  }
  for (const auto& [group, name] : names_)
    if (group.first == 0)
      all.push_back("the " + called(group) + " is left out: vertices carry no markers");
  return all;
}

}  // namespace weft::files

// SPDX-License-Identifier: Apache-2.0
#include "files/formats/meshes/inp_sets.h"

#include "files/base/words.h"

namespace weft::files {

std::size_t InpSets::of(std::string_view name) {
  if (const std::size_t point = name.rfind('.'); point != std::string_view::npos)
    name.remove_prefix(point + 1);
  const auto [found, is_new] = by_name_.try_emplace(lower_case(name), sets_.size());
  if (is_new) sets_.push_back({std::string(name)});
  return found->second;
}

void InpSets::each_of(std::size_t set, const NodeNumbers& numbers,
                      const std::function<void(std::uint32_t)>& act) const {
  std::vector<std::size_t> found = {set};
  std::vector<bool> seen(sets_.size());
  seen[set] = true;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Set& at = sets_[found[i]];
    for (const auto& [first, end] : at.indices)
      for (std::uint32_t index = first; index < end; ++index) act(index);
    for (const Range& range : at.ranges) numbers.each_of(range.first, range.last, range.step, act);
    for (const std::size_t other : at.others) {
      if (seen[other]) continue;
      seen[other] = true;
      found.push_back(other);
    }
  }
}

}  // namespace weft::files

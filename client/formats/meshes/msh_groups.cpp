// SPDX-License-Identifier: Apache-2.0
#include "client/formats/meshes/msh_groups.h"

#include <algorithm>
#include <string>

namespace weft::client {

PhysicalGroups::PhysicalGroups(PagedMemory* pages, std::span<const std::int32_t> values) {
  const auto make_unique = [this] {
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  };
  std::size_t room = 1 << 16;
  for (const std::size_t i : numbers(pages, values.size())) {
    if (i > 0 && values[i] == values[i - 1]) continue;  // runs are long
    ids.push_back(values[i]);
    if (ids.size() < room) continue;
    make_unique();
    room = std::max(room, 2 * ids.size());
  }
  make_unique();

  std::int32_t free = 0;
  const auto next_free = [this, &free] {
    do ++free;
    while (std::binary_search(ids.begin(), ids.end(), free));
    return free;
  };
  for (const std::int32_t id : ids) tags.push_back(id > 0 ? id : next_free());
}

std::size_t PhysicalGroups::find(std::int32_t value) const {
  return static_cast<std::size_t>(std::lower_bound(ids.begin(), ids.end(), value) - ids.begin());
}

void put_physical_names(OutputFile& file, const PhysicalGroups& markers,
                        const PhysicalGroups& regions) {
  std::string text =
      "$PhysicalNames\n" + std::to_string(markers.ids.size() + regions.ids.size()) + "\n";
  const auto add = [&text](const char* dimension, const char* word, const PhysicalGroups& groups) {
    for (std::size_t e = 0; e < groups.ids.size(); ++e)
      text += dimension + std::to_string(groups.tags[e]) + " \"" + word + " " +
              std::to_string(groups.ids[e]) + "\"\n";
  };
  add("1 ", "marker", markers);
  add("2 ", "region", regions);
  file.put(text + "$EndPhysicalNames\n");
}

}  // namespace weft::client

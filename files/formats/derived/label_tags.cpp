// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/label_tags.h"

#include <algorithm>

namespace weft::files {

LabelTags::LabelTags(PagedMemory* pages, std::span<const std::int32_t> values,
                     const NameTable& table)
    : names(table) {
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
    while (std::binary_search(ids.begin(), ids.end(), free) || names.contains(free));
    return free;
  };
  for (const std::int32_t id : ids) tags.push_back(id > 0 ? id : next_free());
}

std::size_t LabelTags::find(std::int32_t value) const {
  return static_cast<std::size_t>(std::lower_bound(ids.begin(), ids.end(), value) - ids.begin());
}

}  // namespace weft::files

// SPDX-License-Identifier: Apache-2.0
// Positive numbers, tags, for regions or markers, in formats that have no others: the tag of a
// region or marker is the number itself if that is positive, otherwise the lowest that is free.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "files/base/paged_memory.h"
#include "files/formats/names.h"

namespace weft::files {

struct LabelTags {
  // `names` are those of regions or of markers, and outlive the tags.
  LabelTags(PagedMemory* pages, std::span<const std::int32_t> values, const NameTable& names);
  // The index of a value in `ids`. REQUIRES: it is one of them.
  std::size_t find(std::int32_t value) const;

  std::vector<std::int32_t> ids;   // regions or markers, ascending
  std::vector<std::int32_t> tags;  // of each
  const NameTable& names;
};

}  // namespace weft::files

// SPDX-License-Identifier: Apache-2.0
// Groups triangles by their region, or edges by their marker. Groups are in the order of the
// labels, and the things of a group keep their own order. Takes 4 bytes for each thing, in the
// mesh's pages.
//
//   const LabelGroups blocks(mesh.pages, mesh.regions, [](std::size_t) { return true; });
//   for (const auto& [region, first, count] : blocks.all())
//     for (std::size_t i = first; i < first + count; ++i) ... blocks[i] ...  // a triangle
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "files/base/paged_memory.h"

namespace weft::files {

class LabelGroups {
 public:
  struct Group {
    std::int32_t label;
    std::size_t first;
    std::size_t count;
  };

  // `is_in(i)`: whether thing i counts.
  template <class IsIn>
  LabelGroups(PagedMemory* pages, std::span<const std::int32_t> labels, const IsIn& is_in)
      : members_(pages, labels.size()) {
    std::map<std::int32_t, std::size_t> next;
    for (const std::size_t i : numbers(pages, labels.size()))
      if (is_in(i)) ++next[labels[i]];
    for (auto& [label, count] : next) {
      groups_.push_back({label, size_, count});
      size_ += count;
      count = groups_.back().first;
    }
    Jumps jumps(pages);
    for (const std::size_t i : numbers(pages, labels.size())) {
      if (!is_in(i)) continue;
      const std::size_t place = next[labels[i]]++;
      jumps.to(place);
      members_[place] = static_cast<std::uint32_t>(i);
    }
  }

  const std::vector<Group>& all() const { return groups_; }
  std::size_t size() const { return size_; }
  std::uint32_t operator[](std::size_t i) const { return members_[i]; }

 private:
  ScratchArray<std::uint32_t> members_;
  std::vector<Group> groups_;
  std::size_t size_ = 0;
};

}  // namespace weft::files

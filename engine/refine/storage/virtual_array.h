// SPDX-License-Identifier: Apache-2.0
// An array that never moves. So a mesh grows without copying, and other threads may read it while
// it grows.
//
// If several threads touch a huge page for the first time at the same moment, each clears one, and
// all but one discard theirs. So the thread that is half through a page commits the next.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <type_traits>
#include <utility>

#include "engine/refine/storage/reserved_memory.h"
#include "weft/error.h"

namespace weft {

template <class T>
class VirtualArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  // Reserves room for `capacity` elements. Their values are undefined, but zero if `pages` is
  // kSmall.
  static Result<VirtualArray> reserve(std::size_t capacity, Pages pages) {
    auto memory = ReservedMemory::reserve(capacity * sizeof(T), pages);
    if (!memory) return tl::unexpected(memory.error());
    VirtualArray array;
    array.memory_ = std::move(*memory);
    return array;
  }

  // Call it with the first of some elements that are used from now on: if it is in the middle of a
  // huge page, the next page is committed. Thread-safe.
  void commit_ahead(std::size_t i) const noexcept {
    constexpr std::size_t kHugePage = ReservedMemory::kHugePage;
    const std::size_t offset = i * sizeof(T);
    if (!memory_.huge_pages() || offset % kHugePage != kHugePage / 2) return;
    const std::size_t next = offset + kHugePage / 2;
    if (next + kHugePage > memory_.bytes()) return;
    madvise(memory_.data() + next, kHugePage, MADV_POPULATE_WRITE);
  }

  T* data() const noexcept { return reinterpret_cast<T*>(memory_.data()); }
  T& operator[](std::size_t i) const noexcept { return data()[i]; }

 private:
  ReservedMemory memory_;
};

}  // namespace weft

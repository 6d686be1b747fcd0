// SPDX-License-Identifier: GPL-3.0-or-later
// An array that never moves: address space for the most that a job may need is reserved at the
// start, and the system commits a page when it is first touched. So a mesh grows without copying,
// and other threads may read it while it does.
//
// Large arrays ask for huge pages: 18 % of the refinement time at 1 M triangles. Small ones do
// not, for clearing 2 MiB costs more than a small mesh.
//
// Threads that touch a huge page for the first time at the same moment all clear one, and all but
// one throw theirs away: 5 % of the time of two threads at 1 M triangles. So the one that is half
// through a page commits the next.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>

#include "engine/error.h"

namespace weft {

template <class T>
class VirtualArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  static constexpr std::size_t kHugePage = std::size_t{2} << 20;

  // Room for `capacity` elements, all bytes zero.
  static Result<VirtualArray> reserve(std::size_t capacity, bool huge_pages) {
    const std::size_t bytes = capacity * sizeof(T) + kHugePage;
    void* raw = mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                     MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (raw == MAP_FAILED) {
      return fail(ErrorCode::kOutOfMemory, "",
                  "cannot reserve " + std::to_string(bytes) + " bytes of address space");
    }
    VirtualArray array;
    array.raw_ = raw;
    array.bytes_ = bytes;
    const auto address = reinterpret_cast<std::uintptr_t>(raw);
    array.data_ = reinterpret_cast<T*>((address + kHugePage - 1) & ~(kHugePage - 1));
    array.huge_pages_ = huge_pages;
    if (huge_pages) madvise(array.data_, capacity * sizeof(T), MADV_HUGEPAGE);
    return array;
  }

  VirtualArray() = default;
  VirtualArray(VirtualArray&& other) noexcept { *this = std::move(other); }
  VirtualArray& operator=(VirtualArray&& other) noexcept {
    std::swap(raw_, other.raw_);
    std::swap(bytes_, other.bytes_);
    std::swap(data_, other.data_);
    std::swap(huge_pages_, other.huge_pages_);
    return *this;
  }
  ~VirtualArray() {
    if (raw_) munmap(raw_, bytes_);
  }

  // To be called with the first of some elements that are used from now on: where it is the one in
  // the middle of a huge page, the page after it is committed. Thread-safe.
  void commit_ahead(std::size_t i) const noexcept {
    const std::size_t offset = i * sizeof(T);
    if (!huge_pages_ || offset % kHugePage != kHugePage / 2) return;
    const std::size_t next = offset + kHugePage / 2;
    if (next + 2 * kHugePage > bytes_) return;
    madvise(reinterpret_cast<std::byte*>(data_) + next, kHugePage, MADV_POPULATE_WRITE);
  }

  T* data() const noexcept { return data_; }
  T& operator[](std::size_t i) const noexcept { return data_[i]; }

 private:
  void* raw_ = nullptr;
  std::size_t bytes_ = 0;
  T* data_ = nullptr;
  bool huge_pages_ = false;
};

}  // namespace weft

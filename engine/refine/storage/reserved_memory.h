// SPDX-License-Identifier: Apache-2.0
// Address space for the most that a job may need: the system commits a page when it is first
// touched, so what lies in it grows without moving.
//
// Large ranges ask for huge pages: 18 % of the refinement time at 1 M triangles. Small ones do
// not, for clearing 2 MiB costs more than a small mesh.
//
// What a job leaves is kept for those that come after it, for clearing pages anew took 6 % of the
// time of one thread at 1 M triangles, and 8 % of two; of a mesh of 18,000, a third of all page
// faults: up to kKeptBytes of up to kKeptRanges ranges with huge pages, and of as many without, or
// less if `keep_at_most` says so. The system may take those pages while nobody uses them
// (MADV_FREE), so they are in nobody's way if memory is short, but they count as the process's.
#pragma once

#include <cstddef>
#include <utility>

#include "engine/base/error.h"

namespace weft {

// kAny: huge ones where another job has left some, otherwise small ones.
enum class Pages { kSmall, kAny, kHuge };

class ReservedMemory {
 public:
  static constexpr std::size_t kHugePage = std::size_t{2} << 20;
  static constexpr std::size_t kKeptRanges = 8;
  static constexpr std::size_t kKeptBytes = std::size_t{64} << 20;

  // At least `bytes` from a multiple of kHugePage on. They hold anything, unless `pages` is
  // kSmall: then zero. Thread-safe. Errors: kOutOfMemory.
  static Result<ReservedMemory> reserve(std::size_t bytes, Pages pages);

  // Bounds what is kept of all ranges together, from the next one that is left on. Thread-safe.
  static void keep_at_most(std::size_t bytes);

  ReservedMemory() = default;
  ReservedMemory(ReservedMemory&& other) noexcept { *this = std::move(other); }
  ReservedMemory& operator=(ReservedMemory&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(bytes_, other.bytes_);
    std::swap(pages_, other.pages_);
    return *this;
  }
  ~ReservedMemory();

  std::byte* data() const noexcept { return data_; }
  std::size_t bytes() const noexcept { return bytes_; }
  bool huge_pages() const noexcept { return pages_ == Pages::kHuge; }

 private:
  std::byte* data_ = nullptr;
  std::size_t bytes_ = 0;
  Pages pages_ = Pages::kSmall;  // kAny: small ones, which may hold anything
};

}  // namespace weft

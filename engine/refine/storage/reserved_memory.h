// SPDX-License-Identifier: Apache-2.0
// Address space for the most that a run may need: the system commits a page when it is first
// touched, so arrays in it grow without moving.
//
// Large ranges use huge pages. Small ones do not, because clearing 2 MiB costs more than a small
// mesh.
//
// The ranges of a run are kept for later runs, because clearing new pages takes time. Up to
// kKeptBytes are kept, of up to kKeptRanges ranges with huge pages and as many without, or less if
// `keep_at_most` says so. The system may take these pages if memory is short while they are not in
// use (MADV_FREE), but they count as the process's memory.
//
// Thread-safety: `reserve` and `keep_at_most`; a range has one owner.
#pragma once

#include <cstddef>
#include <utility>

#include "weft/error.h"

namespace weft {

// kAny: huge pages if another run has left some, otherwise small ones.
enum class Pages { kSmall, kAny, kHuge };

class ReservedMemory {
 public:
  static constexpr std::size_t kHugePage = std::size_t{2} << 20;
  static constexpr std::size_t kKeptRanges = 8;
  static constexpr std::size_t kKeptBytes = std::size_t{64} << 20;

  // Reserves at least `bytes`, aligned to kHugePage. Their contents are undefined, but zero if
  // `pages` is kSmall. Thread-safe. Errors: kOutOfMemory.
  static Result<ReservedMemory> reserve(std::size_t bytes, Pages pages);

  // Bounds the bytes kept of all ranges together, from the next range that a run leaves.
  // Thread-safe.
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

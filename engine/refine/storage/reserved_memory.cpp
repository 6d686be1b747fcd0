// SPDX-License-Identifier: Apache-2.0
#include "engine/refine/storage/reserved_memory.h"

#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace weft {
namespace {

struct Range {
  std::byte* data = nullptr;
  std::size_t bytes = 0;
};

// Bytes of one range.
constinit std::atomic<std::size_t> most_kept = ReservedMemory::kKeptBytes;

void give_back(const Range& range) {
  if (range.data) munmap(range.data, range.bytes);
}

// Ranges of one kind of pages that nobody uses; the one that was left last is in front. Outlives
// all static objects.
class KeptRanges {
 public:
  // The smallest range that has room; of several, the one that was left last.
  std::optional<Range> take(std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    const auto best =
        std::min_element(ranges_.begin(), ranges_.end(), [&](const Range& a, const Range& b) {
          return a.bytes >= bytes && (b.bytes < bytes || a.bytes < b.bytes);
        });
    if (best->bytes < bytes) return std::nullopt;
    const Range result = *best;
    *std::move(best + 1, ranges_.end(), best) = {};
    return result;
  }

  void keep(const Range& range) {
    const std::size_t kept = std::min(range.bytes, most_kept.load(std::memory_order_relaxed));
    if (kept > 0) madvise(range.data, kept, MADV_FREE);
    if (range.bytes > kept) madvise(range.data + kept, range.bytes - kept, MADV_DONTNEED);
    Range oldest;
    {
      const std::lock_guard lock(mutex_);
      oldest = ranges_.back();
      std::move_backward(ranges_.begin(), ranges_.end() - 1, ranges_.end());
      ranges_.front() = range;
    }
    give_back(oldest);
  }

  void give_all_back() {
    std::array<Range, ReservedMemory::kKeptRanges> all;
    {
      const std::lock_guard lock(mutex_);
      all = std::exchange(ranges_, {});
    }
    for (const Range& range : all) give_back(range);
  }

 private:
  std::mutex mutex_;  // guards the one below
  std::array<Range, ReservedMemory::kKeptRanges> ranges_;
};

constinit KeptRanges kept_huge_pages;
constinit KeptRanges kept_small_pages;

// From a multiple of kHugePage on.
std::optional<Range> map(std::size_t bytes) {
  constexpr std::size_t kHugePage = ReservedMemory::kHugePage;
  void* const raw = mmap(nullptr, bytes + kHugePage, PROT_READ | PROT_WRITE,
                         MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (raw == MAP_FAILED) return std::nullopt;
  auto* const first = static_cast<std::byte*>(raw);
  const std::size_t before = -reinterpret_cast<std::uintptr_t>(raw) % kHugePage;
  if (before > 0) munmap(first, before);
  munmap(first + before + bytes, kHugePage - before);
  return Range{first + before, bytes};
}

}  // namespace

Result<ReservedMemory> ReservedMemory::reserve(std::size_t bytes, Pages pages) {
  bytes = (bytes + kHugePage - 1) / kHugePage * kHugePage;
  std::optional<Range> range;
  if (pages != Pages::kSmall) {
    range = kept_huge_pages.take(bytes);
    if (range) pages = Pages::kHuge;
  }
  if (!range && pages == Pages::kAny) range = kept_small_pages.take(bytes);
  if (!range) {
    range = map(bytes);
    if (!range) {
      kept_huge_pages.give_all_back();
      kept_small_pages.give_all_back();
      range = map(bytes);
    }
    if (!range) {
      return fail(ErrorCode::kOutOfMemory, "",
                  "cannot reserve " + std::to_string(bytes) + " bytes of address space");
    }
    if (pages == Pages::kHuge) madvise(range->data, range->bytes, MADV_HUGEPAGE);
  }
  ReservedMemory memory;
  memory.data_ = range->data;
  memory.bytes_ = range->bytes;
  memory.pages_ = pages;
  return memory;
}

void ReservedMemory::keep_at_most(std::size_t bytes) {
  constexpr std::size_t kPage = 4096;
  const std::size_t of_each = bytes / (2 * kKeptRanges) / kPage * kPage;
  most_kept.store(std::min(of_each, kKeptBytes), std::memory_order_relaxed);
}

ReservedMemory::~ReservedMemory() {
  const Range range{data_, bytes_};
  if (pages_ == Pages::kHuge) {
    kept_huge_pages.keep(range);
  } else if (pages_ == Pages::kAny) {
    kept_small_pages.keep(range);
  } else {
    give_back(range);
  }
}

}  // namespace weft

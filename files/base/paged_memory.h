// SPDX-License-Identifier: Apache-2.0
// Storage for arrays that may be larger than memory. Each is in a nameless mapped file, so the
// kernel keeps pages in use and writes the others to disk; the file vanishes with the process,
// whatever ends it.
//
// Pages that a loop touches count as this process's memory, and only `step` or `release` takes them
// from it: a loop over an array calls it every kStride iterations, best by `for (i : numbers(pages,
// count))`. Arrays that are small together stay in memory. Between two steps a loop that goes
// through arrays in order, or nearly, touches a few megabytes; one that jumps at random
// touches a page per iteration.
//
// Errors: std::system_error if there is no room on the disk (ENOSPC) and if a stop was requested
// (ECANCELED). Disk space is reserved when an array is made, so that no later write fails. Not
// thread-safe.
//
//   PagedMemory pages("out", stop);
//   ScratchArray<double> lengths(&pages, mesh.edge_count());
//   for (const std::size_t e : numbers(&pages, lengths.size())) lengths[e] = ...;
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <list>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include "files/base/atomic_file.h"

namespace weft::files {

class PagedMemory {
 public:
  static constexpr std::size_t kStride = std::size_t{1} << 16;
  static constexpr std::size_t kSmall = std::size_t{32} << 20;

  // `small`: bytes of mapped files that may stay in memory, and bytes of arrays without a file.
  explicit PagedMemory(std::filesystem::path folder, std::stop_token stop = {},
                       std::size_t small = kSmall)
      : folder_(std::move(folder)), stop_(std::move(stop)), small_(small) {}
  PagedMemory(const PagedMemory&) = delete;
  PagedMemory& operator=(const PagedMemory&) = delete;
  ~PagedMemory();

  // Returns so many bytes, all 0, for reading and writing. REQUIRES: bytes > 0.
  void* allocate(std::size_t bytes);
  // Maps the first bytes of a file for reading; the file must stay open. REQUIRES: bytes > 0.
  const void* map(int file, std::size_t bytes);
  // Frees what one of the two returned.
  void free(const void* address);

  // Takes all pages of files out of this process's resident memory, unless they are small; the
  // contents stay.
  void release();
  // The same, but throws if a stop was requested.
  void step();

 private:
  struct Mapping {
    void* address;
    std::size_t bytes;
    int file;              // -1: memory without a file
    FileDescriptor own{};  // of `allocate`
  };
  Mapping& add(std::size_t bytes, int file, int protection);

  std::filesystem::path folder_;
  std::stop_token stop_;
  std::size_t small_;
  std::list<Mapping> mappings_;
  std::size_t in_files_ = 0;  // bytes
  std::size_t in_memory_ = 0;
};

// An array of values, all 0 at first; without PagedMemory, in ordinary memory.
template <class T>
class ScratchArray {
 public:
  ScratchArray() = default;
  ScratchArray(PagedMemory* pages, std::size_t count) : pages_(pages), size_(count) {
    if (pages_ == nullptr) {
      values_.resize(count);
      data_ = values_.data();
    } else if (count > 0) {
      data_ = static_cast<T*>(pages_->allocate(count * sizeof(T)));
    }
  }
  ScratchArray(ScratchArray&& other) noexcept { *this = std::move(other); }
  ScratchArray& operator=(ScratchArray&& other) noexcept {
    std::swap(pages_, other.pages_);
    std::swap(values_, other.values_);
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    return *this;
  }
  ~ScratchArray() {
    if (pages_ != nullptr && data_ != nullptr) pages_->free(data_);
  }

  std::size_t size() const { return size_; }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }
  std::span<const T> values() const { return {data_, size_}; }

 private:
  PagedMemory* pages_ = nullptr;
  std::vector<T> values_;
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

// 0, 1, ... count - 1, with steps of `pages`, which may be null, in between.
class Numbers {
 public:
  class Iterator {
   public:
    Iterator(PagedMemory* pages, std::size_t at) : pages_(pages), at_(at) {}
    std::size_t operator*() const { return at_; }
    Iterator& operator++() {
      if (++at_ % PagedMemory::kStride == 0 && pages_ != nullptr) pages_->step();
      return *this;
    }
    bool operator==(const Iterator& other) const { return at_ == other.at_; }

   private:
    PagedMemory* pages_;
    std::size_t at_;
  };

  Numbers(PagedMemory* pages, std::size_t count) : pages_(pages), count_(count) {}
  Iterator begin() const { return {pages_, 0}; }
  Iterator end() const { return {pages_, count_}; }

 private:
  PagedMemory* pages_;
  std::size_t count_;
};

inline Numbers numbers(PagedMemory* pages, std::size_t count) {
  return {pages, count};
}

// For a loop that sometimes jumps in an array: given each position, it steps after the jumps have
// touched a few megabytes.
class Jumps {
 public:
  explicit Jumps(PagedMemory* pages) : pages_(pages) {}
  void to(std::size_t place) {
    constexpr std::size_t kNear = PagedMemory::kStride;
    constexpr int kMax = 128;  // each may map 64 KiB, the kernel's fault-around
    if (place - last_ + kNear > 2 * kNear && ++jumps_ == kMax) {
      jumps_ = 0;
      if (pages_ != nullptr) pages_->step();
    }
    last_ = place;
  }

 private:
  PagedMemory* pages_;
  std::size_t last_ = 0;
  int jumps_ = 0;
};

// Calls piece(values) for one piece of the array after the other, with steps in between.
template <class T, class Piece>
void in_pieces(PagedMemory* pages, std::span<const T> values, Piece&& piece) {
  constexpr std::size_t kPiece = (std::size_t{1} << 20) / sizeof(T);
  while (!values.empty()) {
    const std::size_t size = std::min(values.size(), kPiece);
    piece(values.first(size));
    values = values.subspan(size);
    if (pages != nullptr) pages->step();
  }
}

}  // namespace weft::files

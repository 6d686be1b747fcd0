// SPDX-License-Identifier: GPL-3.0-or-later
// Hands out the numbers of blocks; those given back first. Thread-safe. A block is taken once in a
// few hundred insertions, so a mutex is good enough.
#pragma once

#include <cstdint>
#include <mutex>
#include <new>
#include <vector>

namespace weft {

class BlockPool {
 public:
  // Blocks below `taken` are taken already.
  BlockPool(std::uint32_t taken, std::uint32_t capacity) : fresh_(taken), capacity_(capacity) {}

  // Throws std::bad_alloc where all are taken.
  std::uint32_t take() {
    const std::lock_guard lock(mutex_);
    if (!free_.empty()) {
      const std::uint32_t block = free_.back();
      free_.pop_back();
      return block;
    }
    if (fresh_ == capacity_) throw std::bad_alloc();
    return fresh_++;
  }

  void give_back(std::uint32_t block) {
    const std::lock_guard lock(mutex_);
    free_.push_back(block);
  }

  // Most blocks that were ever taken at the same time.
  std::uint32_t peak() const {
    const std::lock_guard lock(mutex_);
    return fresh_;
  }

 private:
  mutable std::mutex mutex_;  // guards all below
  std::uint32_t fresh_;       // from here on no block was ever taken
  const std::uint32_t capacity_;
  std::vector<std::uint32_t> free_;
};

}  // namespace weft

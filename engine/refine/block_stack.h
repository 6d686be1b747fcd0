// SPDX-License-Identifier: GPL-3.0-or-later
// A stack that grows and shrinks by blocks: it never copies, and holds little more memory than its
// entries need. A doubling vector would hold up to 4 bytes a triangle more at the peak.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace weft {

template <class T>
class BlockStack {
 public:
  BlockStack() { add_block(); }

  bool empty() const { return top_ == begin_ && blocks_.size() == 1; }

  void push(T value) {
    if (top_ == begin_ + kBlock) [[unlikely]]
      add_block();
    *top_++ = value;
  }

  // REQUIRES: not empty.
  T pop() {
    if (top_ == begin_) [[unlikely]] {
      blocks_.pop_back();
      begin_ = blocks_.back().get();
      top_ = begin_ + kBlock;
    }
    return *--top_;
  }

  std::size_t peak_bytes() const { return peak_blocks_ * kBlock * sizeof(T); }

 private:
  static constexpr std::size_t kBlock = 4096;

  void add_block() {
    blocks_.push_back(std::make_unique_for_overwrite<T[]>(kBlock));
    begin_ = top_ = blocks_.back().get();
    if (blocks_.size() > peak_blocks_) peak_blocks_ = blocks_.size();
  }

  std::vector<std::unique_ptr<T[]>> blocks_;
  T* begin_ = nullptr;  // of the last block
  T* top_ = nullptr;
  std::size_t peak_blocks_ = 0;
};

}  // namespace weft

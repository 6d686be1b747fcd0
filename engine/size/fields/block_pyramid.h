// SPDX-License-Identifier: Apache-2.0
// The least and the largest of the items of a grid, over any range of columns and rows, in constant
// time: blocks of 2^level items each way hold their extremes.
//
// The items themselves stay with the caller, who passes the same function `items` to `build` and to
// `over`: items(i0, i1, j0, j1) is the hull of the items of columns i0 to i1 and rows j0 to j1,
// last included, with lo > hi if none of them is a number. Blocks begin at 8 x 8 items, which take
// half a byte for each item; smaller ranges are read from the items, 400 at most. Blocks from 2 x 2
// took 8 bytes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/context.h"
#include "engine/size/fields/polled_loop.h"
#include "engine/size/interval.h"
#include "weft/error.h"

namespace weft {

// The hull of no value; `add` grows it.
inline constexpr Interval kNoValue{std::numeric_limits<double>::infinity(),
                                   -std::numeric_limits<double>::infinity(), false};

// A NaN adds nothing.
inline void add(Interval& to, double value) {
  to.lo = value < to.lo ? value : to.lo;
  to.hi = value > to.hi ? value : to.hi;
}

inline void add(Interval& to, const Interval& other) {
  to.lo = other.lo < to.lo ? other.lo : to.lo;
  to.hi = other.hi > to.hi ? other.hi : to.hi;
  to.may_be_nan = to.may_be_nan || other.may_be_nan;
}

class BlockPyramid {
 public:
  static constexpr std::uint32_t kAtATime = 4;

  // REQUIRES: columns, rows > 0. Errors: those of context.poll.
  template <class Items>
  std::optional<Error> build(std::uint32_t columns, std::uint32_t rows, const Items& items,
                             const ExecutionContext& context) {
    columns_ = columns;
    rows_ = rows;
    levels_.clear();
    std::optional<Error> error;
    for_each_level(columns, rows, [&](std::uint32_t level, std::uint32_t wide, std::uint32_t high) {
      if (error) return;
      Level made{wide, std::vector<Interval>(std::size_t{wide} * high)};
      error = polled_loop(context, high, [&](std::size_t row) {
        const auto j = static_cast<std::uint32_t>(row);
        for (std::uint32_t i = 0; i < wide; ++i)
          made.blocks[row * wide + i] =
              level == kFirstLevel ? aligned(i, i, j, j, level, items) : of_four(i, j);
      });
      levels_.push_back(std::move(made));
    });
    return error;
  }

  // Over all items whose block of some level meets the range. That level is the first of which the
  // range meets at most kAtATime + 1 blocks each way.
  template <class Items>
  Interval over(std::uint32_t i0, std::uint32_t i1, std::uint32_t j0, std::uint32_t j1,
                const Items& items) const {
    const auto top = static_cast<std::uint32_t>(kFirstLevel - 1 + levels_.size());
    std::uint32_t level = 0;
    while (level < top &&
           ((i1 >> level) - (i0 >> level) > kAtATime || (j1 >> level) - (j0 >> level) > kAtATime))
      ++level;
    if (level < kFirstLevel)
      return aligned(i0 >> level, i1 >> level, j0 >> level, j1 >> level, level, items);
    return hull(levels_[level - kFirstLevel], i0 >> level, i1 >> level, j0 >> level, j1 >> level);
  }

  std::size_t bytes() const noexcept {
    std::size_t bytes = 0;
    for (const Level& level : levels_) bytes += level.blocks.capacity() * sizeof(Interval);
    return bytes;
  }

  // What `build` takes.
  static std::uint64_t bytes_for(std::uint32_t columns, std::uint32_t rows) {
    std::uint64_t bytes = 0;
    for_each_level(columns, rows, [&](std::uint32_t, std::uint32_t wide, std::uint32_t high) {
      bytes += std::uint64_t{wide} * high * sizeof(Interval);
    });
    return bytes;
  }

 private:
  static constexpr std::uint32_t kFirstLevel = 3;

  struct Level {
    std::uint32_t columns;
    std::vector<Interval> blocks;
  };

  // Calls f(level, columns, rows) for each level that is stored.
  template <class F>
  static void for_each_level(std::uint32_t columns, std::uint32_t rows, const F& f) {
    const auto blocks = [](std::uint32_t items, std::uint32_t level) {
      return ((items - 1) >> level) + 1;
    };
    for (std::uint32_t level = kFirstLevel;
         blocks(columns, level - 1) > kAtATime || blocks(rows, level - 1) > kAtATime; ++level)
      f(level, blocks(columns, level), blocks(rows, level));
  }

  // The items of blocks i0 to i1 and j0 to j1 of a level.
  template <class Items>
  Interval aligned(std::uint32_t i0, std::uint32_t i1, std::uint32_t j0, std::uint32_t j1,
                   std::uint32_t level, const Items& items) const {
    const std::uint32_t rest = (1u << level) - 1;
    return items(i0 << level, std::min((i1 << level) + rest, columns_ - 1), j0 << level,
                 std::min((j1 << level) + rest, rows_ - 1));
  }

  static Interval hull(const Level& level, std::uint32_t i0, std::uint32_t i1, std::uint32_t j0,
                       std::uint32_t j1) {
    Interval found = kNoValue;
    for (std::uint32_t j = j0; j <= j1; ++j)
      for (std::uint32_t i = i0; i <= i1; ++i)
        add(found, level.blocks[std::size_t{j} * level.columns + i]);
    return found;
  }

  // Of the four blocks, or fewer at the border, that block (i, j) of the next level joins.
  Interval of_four(std::uint32_t i, std::uint32_t j) const {
    const Level& below = levels_.back();
    const auto rows = static_cast<std::uint32_t>(below.blocks.size() / below.columns);
    return hull(below, 2 * i, std::min(2 * i + 1, below.columns - 1), 2 * j,
                std::min(2 * j + 1, rows - 1));
  }

  std::uint32_t columns_ = 0;
  std::uint32_t rows_ = 0;
  std::vector<Level> levels_;
};

}  // namespace weft

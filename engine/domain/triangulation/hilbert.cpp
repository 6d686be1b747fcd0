// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/triangulation/hilbert.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>

namespace weft {
namespace {

constexpr unsigned kLevels = 24;

// The curve, four levels at a time. A level's turn mirrors the cell, or swaps its coordinates, or
// both, in the quadrant that the curve descends into: four states.
constexpr unsigned kStep = 4;
static_assert(kLevels % kStep == 0);

// Entry state << 8 | x << 4 | y: the state after four levels in the upper byte, what they add to
// the key in the lower.
constexpr std::array<std::uint16_t, 4 << 2 * kStep> kCurve = [] {
  std::array<std::uint16_t, 4 << 2 * kStep> table{};
  for (std::uint32_t state = 0; state < 4; ++state) {
    for (std::uint32_t cell = 0; cell < 1u << 2 * kStep; ++cell) {
      std::uint32_t x = cell >> kStep;
      std::uint32_t y = cell & ((1u << kStep) - 1);
      std::uint32_t key = 0;
      std::uint32_t mirrored = state >> 1;
      std::uint32_t swapped = state & 1;
      for (unsigned level = kStep; level-- > 0;) {
        std::uint32_t right = (x >> level & 1) ^ mirrored;
        std::uint32_t upper = (y >> level & 1) ^ mirrored;
        if (swapped) std::swap(right, upper);
        key = key << 2 | ((3 * right) ^ upper);
        if (upper == 1) continue;
        swapped ^= 1;
        mirrored ^= right;
      }
      table[state << 2 * kStep | cell] =
          static_cast<std::uint16_t>((mirrored << 1 | swapped) << 8 | key);
    }
  }
  return table;
}();

// Position of cell (x, y) along the curve.
std::uint64_t hilbert_key(std::uint32_t x, std::uint32_t y) {
  constexpr std::uint32_t kMask = (1u << kStep) - 1;
  std::uint64_t key = 0;
  std::uint32_t state = 0;
  for (unsigned level = kLevels; level > 0;) {
    level -= kStep;
    const std::uint16_t entry =
        kCurve[state << 2 * kStep | (x >> level & kMask) << kStep | (y >> level & kMask)];
    key = key << 2 * kStep | (entry & 0xff);
    state = entry >> 8;
  }
  return key;
}

struct Entry {
  std::uint64_t key;
  std::uint32_t index;
};

constexpr unsigned kDigitBits = 12;
constexpr unsigned kDigits = 2 * kLevels / kDigitBits;
static_assert(2 * kLevels % kDigitBits == 0);

// Sorts by the digits from `first` on, the least significant one first; entries that are equal in
// these keep their order. std::sort of millions of entries could not be stopped in time.
void radix_sort(std::vector<Entry>& entries, unsigned first, StopPoller& poller) {
  constexpr std::size_t kValues = std::size_t{1} << kDigitBits;
  std::vector<std::uint32_t> starts((kDigits - first) * kValues);
  const auto starts_of = [&](unsigned d) { return &starts[(d - first) * kValues]; };
  for (const Entry& e : entries) {
    poller.step();
    for (unsigned d = first; d < kDigits; ++d)
      ++starts_of(d)[e.key >> d * kDigitBits & (kValues - 1)];
  }
  std::vector<Entry> sorted(entries.size());
  for (unsigned d = first; d < kDigits; ++d) {
    std::uint32_t* const start = starts_of(d);
    std::uint32_t sum = 0;
    for (std::size_t v = 0; v < kValues; ++v) sum += std::exchange(start[v], sum);
    for (const Entry& e : entries) {
      poller.step();
      sorted[start[e.key >> d * kDigitBits & (kValues - 1)]++] = e;
    }
    entries.swap(sorted);
  }
}

// Sorts by key; entries with equal keys keep their order. The upper halves of most keys differ, so
// half of the passes sort all but a few neighbours, which are then sorted by themselves. The tables
// of the passes take longer than comparing a handful.
void sort_by_key(std::vector<Entry>& entries, StopPoller& poller) {
  constexpr std::size_t kHandful = 1 << 9;
  constexpr std::size_t kFew = 1 << 16;
  const auto by_key = [](const Entry& a, const Entry& b) { return a.key < b.key; };
  if (entries.size() < kHandful) {
    std::stable_sort(entries.begin(), entries.end(), by_key);
    return;
  }
  if (entries.size() >= kFew) return radix_sort(entries, 0, poller);
  constexpr unsigned kUpper = kDigits / 2;
  radix_sort(entries, kUpper, poller);
  const auto upper = [](const Entry& e) { return e.key >> kUpper * kDigitBits; };
  for (auto first = entries.begin(), last = first; first != entries.end(); first = last) {
    while (++last != entries.end() && upper(*last) == upper(*first)) continue;
    if (last - first > 1) std::stable_sort(first, last, by_key);
  }
}

// Sorts `order`, numbers of points. The grid is finer by 2^24 at each level, and all doubles are
// within 2^2100 of each other, so the recursion is shallow.
void sort_along_curve(const std::vector<Point>& points, std::span<std::uint32_t> order,
                      StopPoller& poller) {
  constexpr std::size_t kCrowd = 64;
  constexpr double kSmallestSide = 1e-290;  // so that the scale is finite
  Box box;
  for (const std::uint32_t i : order) box.add(points[i]);
  const double side = std::max(box.width(), box.height());
  if (!(side > kSmallestSide)) return;
  const double scale = ((1u << kLevels) - 1) / side;

  std::vector<Entry> entries(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    poller.step();
    const Point p = points[order[k]];
    const auto x = static_cast<std::uint32_t>((p.x - box.min_x) * scale);
    const auto y = static_cast<std::uint32_t>((p.y - box.min_y) * scale);
    entries[k] = {hilbert_key(x, y), order[k]};
  }
  sort_by_key(entries, poller);
  std::vector<std::span<std::uint32_t>> crowds;
  for (std::size_t first = 0, last; first < order.size(); first = last) {
    for (last = first; last < order.size() && entries[last].key == entries[first].key; ++last) {
      poller.step();
      order[last] = entries[last].index;
    }
    if (last - first > kCrowd) crowds.push_back(order.subspan(first, last - first));
  }
  entries = {};  // one level's at a time
  for (const std::span<std::uint32_t> crowd : crowds) sort_along_curve(points, crowd, poller);
}

}  // namespace

std::vector<std::uint32_t> hilbert_order(const std::vector<Point>& points, StopPoller& poller) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  sort_along_curve(points, order, poller);
  return order;
}

}  // namespace weft

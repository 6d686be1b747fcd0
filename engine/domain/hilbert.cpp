// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/domain/hilbert.h"

#include <array>
#include <cstddef>
#include <utility>

namespace weft {
namespace {

constexpr unsigned kLevels = 24;

// Position of cell (x, y) along the curve, from the coarsest level down: each level turns the
// quadrant that it descends into. Without branches, for their outcomes are random.
std::uint64_t hilbert_key(std::uint32_t x, std::uint32_t y) {
  std::uint64_t key = 0;
  for (unsigned level = kLevels; level-- > 0;) {
    const std::uint32_t right = x >> level & 1;
    const std::uint32_t upper = y >> level & 1;
    key = key << 2 | ((3 * right) ^ upper);
    const std::uint32_t turn = upper - 1;  // all ones in the two lower quadrants
    const std::uint32_t mirror = turn & (0 - right);
    const std::uint32_t swap = (x ^ y) & turn;
    x ^= swap ^ mirror;
    y ^= swap ^ mirror;
  }
  return key;
}

struct Entry {
  std::uint64_t key;
  std::uint32_t index;
};

// Least significant digit first, so points with equal keys keep their order. A standard sort of
// millions of entries could not be stopped in time.
void radix_sort(std::vector<Entry>& entries, Pacer& pacer) {
  constexpr unsigned kDigitBits = 12;
  static_assert(2 * kLevels % kDigitBits == 0);
  std::vector<Entry> sorted(entries.size());
  for (unsigned shift = 0; shift < 2 * kLevels; shift += kDigitBits) {
    std::array<std::uint32_t, 1u << kDigitBits> start{};
    const auto digit = [shift, &start](const Entry& e) {
      return e.key >> shift & (start.size() - 1);
    };
    for (const Entry& e : entries) ++start[digit(e)];
    std::uint32_t sum = 0;
    for (std::uint32_t& s : start) sum += std::exchange(s, sum);
    for (const Entry& e : entries) {
      pacer.step();
      sorted[start[digit(e)]++] = e;
    }
    entries.swap(sorted);
  }
}

}  // namespace

std::vector<std::uint32_t> hilbert_order(const std::vector<Point>& points, Pacer& pacer) {
  Box box;
  for (const Point p : points) box.add(p);
  const double side = std::max(box.width(), box.height());
  const double scale = side > 0 ? ((1u << kLevels) - 1) / side : 0;

  std::vector<Entry> entries(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    pacer.step();
    const auto x = static_cast<std::uint32_t>((points[i].x - box.min_x) * scale);
    const auto y = static_cast<std::uint32_t>((points[i].y - box.min_y) * scale);
    entries[i] = {hilbert_key(x, y), static_cast<std::uint32_t>(i)};
  }
  radix_sort(entries, pacer);

  std::vector<std::uint32_t> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = entries[i].index;
  return order;
}

}  // namespace weft

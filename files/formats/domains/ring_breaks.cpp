// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/ring_breaks.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace weft::files {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Box {
  Point low{kInfinity, kInfinity};
  Point high{-kInfinity, -kInfinity};

  void add(Point p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  // How far outside the point is, along the axes; 0 or less if it is inside.
  double distance(Point p) const {
    return std::max({low.x - p.x, p.x - high.x, low.y - p.y, p.y - high.y});
  }
  double size() const { return std::max(high.x - low.x, high.y - low.y); }
};

bool is_candidate(Point p) {
  constexpr double kValues[] = {999, 9999, 99999, 999999, 9999999};
  return p.x == p.y &&
         std::find(std::begin(kValues), std::end(kValues), std::abs(p.x)) != std::end(kValues);
}

// Whether the corners are a ring by their number.
bool is_ring(std::span<const RingCorner> corners) {
  const auto differs = [](Point p) { return [p](const RingCorner& c) { return c.at != p; }; };
  const Point first = corners.front().at;
  const auto second = std::find_if(corners.begin(), corners.end(), differs(first));
  return second != corners.end() && std::any_of(second, corners.end(), [&](const RingCorner& c) {
           return c.at != first && c.at != second->at;
         });
}

// The rows of one value.
RingBreaks breaks_of(std::span<const RingCorner> corners, double value) {
  std::vector<std::size_t> rows;
  Box box;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (corners[i].at == Point{value, value})
      rows.push_back(i);
    else
      box.add(corners[i].at);
  }
  if (box.distance({value, value}) <= 0) return {};
  std::size_t rings = 0;
  bool all_closed = true;
  std::size_t start = 0;
  for (std::size_t i = 0; i <= corners.size(); ++i) {
    const bool is_row = i < corners.size() && corners[i].at == Point{value, value};
    if (i < corners.size() && !is_row && !(corners[i].starts_ring && i > start)) continue;
    if (i > start) {
      const auto ring = corners.subspan(start, i - start);
      if (!is_ring(ring)) return {{}, rows};
      all_closed = all_closed && ring.front().at == ring.back().at;
      ++rings;
    }
    start = is_row ? i + 1 : i;
  }
  const bool sure =
      rows.size() > 1 || rings > 1 || all_closed || box.distance({value, value}) > box.size();
  return rings > 0 && sure ? RingBreaks{rows, {}} : RingBreaks{{}, rows};
}

}  // namespace

RingBreaks ring_breaks(std::span<const RingCorner> corners) {
  std::vector<double> values;
  for (const RingCorner& corner : corners)
    if (is_candidate(corner.at) &&
        std::find(values.begin(), values.end(), corner.at.x) == values.end())
      values.push_back(corner.at.x);
  RingBreaks all;
  for (const double value : values) {
    const RingBreaks of_value = breaks_of(corners, value);
    all.ends.insert(all.ends.end(), of_value.ends.begin(), of_value.ends.end());
    all.doubtful.insert(all.doubtful.end(), of_value.doubtful.begin(), of_value.doubtful.end());
  }
  std::sort(all.ends.begin(), all.ends.end());
  std::sort(all.doubtful.begin(), all.doubtful.end());
  return all;
}

}  // namespace weft::files

// SPDX-License-Identifier: Apache-2.0
#include "engine/size/fields/line_tree.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "engine/size/fields/polled_loop.h"

namespace weft {
namespace {

// The coordinates by which lines are told apart, doubled.
double coordinate(const StraightLine& line, int axis) {
  switch (axis) {
    case 0:
      return 2 * line.ax + line.ux;
    case 1:
      return 2 * line.ay + line.uy;
    case 2:
      return line.ux;
    default:
      return line.uy;
  }
}

// Calls f(i) for i < n in groups that take about 100 us each.
template <class F>
std::optional<Error> in_groups(const ExecutionContext& context, std::size_t n, std::size_t lines,
                               F&& f) {
  constexpr std::size_t kLinesAtATime = 4096;
  const std::size_t group =
      std::max<std::size_t>(1, kLinesAtATime * n / std::max<std::size_t>(1, lines));
  return polled_loop(context, (n + group - 1) / group, [&](std::size_t g) -> std::optional<Error> {
    const std::size_t end = std::min(n, (g + 1) * group);
    for (std::size_t i = g * group; i < end; ++i) f(i);
    return std::nullopt;
  });
}

}  // namespace

Result<LineTree> LineTree::make(std::vector<StraightLine> lines, const ExecutionContext& context) {
  LineTree tree;
  tree.lines_ = std::move(lines);
  const std::size_t n = tree.lines_.size();
  int levels = 0;
  while (n > std::size_t{kLeafSize} << levels) ++levels;

  std::vector<Range> ranges{{0, static_cast<std::uint32_t>(n)}};
  for (int level = 0; level < levels; ++level) {
    std::vector<Range> halves(2 * ranges.size());
    if (auto error = in_groups(context, ranges.size(), n,
                               [&](std::size_t i) { tree.split(ranges[i], &halves[2 * i]); }))
      return tl::unexpected(*error);
    ranges = std::move(halves);
  }
  std::uint32_t end = 0;
  tree.first_.reserve(ranges.size() + 1);
  for (const Range& range : ranges) {
    tree.first_.push_back(end);
    std::copy_n(tree.lines_.begin() + range.first, range.count, tree.lines_.begin() + end);
    end += range.count;
  }
  tree.first_.push_back(end);
  tree.lines_.resize(end);
  tree.lines_.shrink_to_fit();

  tree.boxes_.resize(2 * ranges.size());
  for (int level = 0; level <= levels; ++level) {
    const std::size_t nodes = std::size_t{1} << level;
    const std::size_t leaves = ranges.size() / nodes;  // per node
    if (auto error = in_groups(context, nodes, n, [&](std::size_t i) {
          tree.boxes_[nodes + i] =
              tree.box_around(tree.first_[i * leaves], tree.first_[(i + 1) * leaves]);
        }))
      return tl::unexpected(*error);
  }
  return tree;
}

std::size_t LineTree::bytes() const noexcept {
  return lines_.capacity() * sizeof(StraightLine) + boxes_.capacity() * sizeof(TurnedBox) +
         first_.capacity() * sizeof(std::uint32_t);
}

// Orders the lines of the range, and drops all but one if they are the same.
void LineTree::split(Range& range, Range* halves) {
  const auto begin = lines_.begin() + range.first;
  constexpr double kSame = 0x1p-42;
  int widest = 0;
  double most = 0;
  double magnitude = 2;  // twice the unit of length
  for (int axis = 0; axis < 4; ++axis) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (auto line = begin; line != begin + range.count; ++line) {
      low = std::min(low, coordinate(*line, axis));
      high = std::max(high, coordinate(*line, axis));
    }
    magnitude = std::max({magnitude, -low, high});
    if (high - low > most) {
      most = high - low;
      widest = axis;
    }
  }
  if (most <= kSame * magnitude) range.count = std::min<std::uint32_t>(range.count, 1);
  const std::uint32_t half = (range.count + 1) / 2;
  if (range.count > 1) {
    std::nth_element(begin, begin + half, begin + range.count,
                     [&](const StraightLine& s, const StraightLine& t) {
                       return coordinate(s, widest) < coordinate(t, widest);
                     });
  }
  halves[0] = {range.first, half};
  halves[1] = {range.first + half, range.count - half};
}

LineTree::TurnedBox LineTree::box_around(std::size_t first, std::size_t end) const {
  TurnedBox box{{0, 0}, 1, 0, -1, -1};
  if (first == end) return box;
  const auto for_each_end = [&](auto&& f) {
    for (std::size_t i = first; i < end; ++i) {
      f(Point{lines_[i].ax, lines_[i].ay});
      f(lines_[i].end());
    }
  };
  Box straight;
  for_each_end([&](Point p) { straight.add(p); });
  box.middle = {0.5 * (straight.min_x + straight.max_x), 0.5 * (straight.min_y + straight.max_y)};
  // The principal axis of the end points.
  const double extent = std::max(straight.width(), straight.height());
  if (extent > 0) {
    const double scale = 1 / extent;
    double sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
    for_each_end([&](Point p) {
      const double x = (p.x - box.middle.x) * scale;
      const double y = (p.y - box.middle.y) * scale;
      sx += x;
      sy += y;
      sxx += x * x;
      sxy += x * y;
      syy += y * y;
    });
    const double count = 2 * static_cast<double>(end - first);
    const double a = 0.5 * ((sxx - sx * sx / count) - (syy - sy * sy / count));
    const double b = sxy - sx * sy / count;
    const double r = std::sqrt(a * a + b * b);
    const double ex = a >= 0 ? a + r : b;
    const double ey = a >= 0 ? b : r - a;
    const double length = std::sqrt(ex * ex + ey * ey);
    if (length > 1e-12) {
      box.ex = ex / length;
      box.ey = ey / length;
    }
  }
  double low_along = std::numeric_limits<double>::infinity();
  double high_along = -low_along;
  double low_across = low_along;
  double high_across = -low_along;
  for_each_end([&](Point p) {
    const double x = p.x - box.middle.x;
    const double y = p.y - box.middle.y;
    const double along = x * box.ex + y * box.ey;
    const double across = y * box.ex - x * box.ey;
    low_along = std::min(low_along, along);
    high_along = std::max(high_along, along);
    low_across = std::min(low_across, across);
    high_across = std::max(high_across, across);
  });
  const double along = 0.5 * (low_along + high_along);
  const double across = 0.5 * (low_across + high_across);
  box.middle = {box.middle.x + along * box.ex - across * box.ey,
                box.middle.y + along * box.ey + across * box.ex};
  box.half_along = 0;
  box.half_across = 0;
  for_each_end([&](Point p) {
    const double x = p.x - box.middle.x;
    const double y = p.y - box.middle.y;
    box.half_along = std::max(box.half_along, std::fabs(x * box.ex + y * box.ey));
    box.half_across = std::max(box.half_across, std::fabs(y * box.ex - x * box.ey));
  });
  // Covers the rounding of all distances to lines within, so far as it grows with their length.
  const double rounding = 0x1p-46 * (box.half_along + box.half_across);
  box.half_along += rounding;
  box.half_across += rounding;
  return box;
}

// A lower bound of the squared distance to any line in the box.
double LineTree::least(const TurnedBox& box, Point p) noexcept {
  if (box.half_along < 0) return std::numeric_limits<double>::infinity();
  const double x = p.x - box.middle.x;
  const double y = p.y - box.middle.y;
  const double along = std::fabs(x * box.ex + y * box.ey) - box.half_along;
  const double across = std::fabs(y * box.ex - x * box.ey) - box.half_across;
  const double a = std::max(along, 0.0);
  const double c = std::max(across, 0.0);
  return (a * a + c * c) * (1 - 0x1p-46);
}

LineTree::Nearest LineTree::nearest(Point p, std::uint32_t guess) const noexcept {
  struct Entry {
    double least;
    std::size_t node;
  };
  const std::size_t leaves = first_.size() - 1;
  Nearest found{lines_[guess].square(p), guess, 1};
  std::array<Entry, kMaxLevels + 2> stack;  // one node of each level, two of the last
  stack[0] = {0, 1};
  std::size_t size = 1;
  while (size > 0) {
    const Entry entry = stack[--size];
    if (!(entry.least < found.square)) continue;
    if (entry.node >= leaves) {
      const std::size_t leaf = entry.node - leaves;
      for (std::uint32_t i = first_[leaf]; i < first_[leaf + 1]; ++i) {
        const double square = lines_[i].square(p);
        if (square < found.square) {
          found.square = square;
          found.line = i;
        }
      }
      found.looks += first_[leaf + 1] - first_[leaf];
      continue;
    }
    found.looks += 2;
    Entry farther{least(boxes_[2 * entry.node], p), 2 * entry.node};
    Entry nearer{least(boxes_[2 * entry.node + 1], p), 2 * entry.node + 1};
    if (farther.least < nearer.least) std::swap(farther, nearer);
    if (farther.least < found.square) stack[size++] = farther;
    if (nearer.least < found.square) stack[size++] = nearer;
  }
  return found;
}

LineTree::Numbers LineTree::with_leasts(std::vector<double> of_line) const {
  const std::size_t leaves = first_.size() - 1;
  Numbers numbers{std::move(of_line),
                  std::vector<double>(2 * leaves, std::numeric_limits<double>::infinity())};
  for (std::size_t leaf = 0; leaf < leaves; ++leaf)
    for (std::uint32_t i = first_[leaf]; i < first_[leaf + 1]; ++i)
      numbers.of_node[leaves + leaf] = std::min(numbers.of_node[leaves + leaf], numbers.of_line[i]);
  for (std::size_t node = leaves; node-- > 1;)
    numbers.of_node[node] = std::min(numbers.of_node[2 * node], numbers.of_node[2 * node + 1]);
  return numbers;
}

double LineTree::least_near(const Numbers& numbers, Point p, double distance) const noexcept {
  const std::size_t leaves = first_.size() - 1;
  const double square = distance * distance;
  double found = std::numeric_limits<double>::infinity();
  std::array<std::size_t, kMaxLevels + 2> stack;  // one node of each level, two of the last
  stack[0] = 1;
  std::size_t size = 1;
  while (size > 0) {
    const std::size_t node = stack[--size];
    if (numbers.of_node[node] >= found || least(boxes_[node], p) > square) continue;
    if (node < leaves) {
      const bool second = numbers.of_node[2 * node + 1] < numbers.of_node[2 * node];
      stack[size++] = 2 * node + !second;
      stack[size++] = 2 * node + second;
      continue;
    }
    for (std::uint32_t i = first_[node - leaves]; i < first_[node - leaves + 1]; ++i)
      if (numbers.of_line[i] < found && lines_[i].square(p) * (1 - 0x1p-46) <= square)
        found = numbers.of_line[i];
  }
  return found;
}

}  // namespace weft

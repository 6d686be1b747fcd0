// SPDX-License-Identifier: Apache-2.0
// Lines in a binary tree of turned boxes: the distance to the nearest, from anywhere.
//
// A tree halves the lines at the median of the coordinate that they differ most in, of four: the
// middle and the half of the direction, x and y. So lines that cross at one point part by their
// direction. Each node has a box that is turned along its lines: pieces of a straight line have
// boxes without width, pieces of a circle almost.
//
// Lines that agree to 2^-42 of the unit, or of their distance from the origin if that is larger,
// may count as one, because they would all have to be looked at from everywhere.
//
// S. Gottschalk, M. Lin and D. Manocha, "OBBTree: A Hierarchical Structure for Rapid Interference
// Detection", SIGGRAPH 1996.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/base/context.h"
#include "engine/size/fields/line_distance.h"

namespace weft {

class LineTree {
 public:
  LineTree() = default;

  // REQUIRES: one line at least, at most 2^27; the points asked for lie about the origin, some
  // units from it. The same tree on any number of threads.
  // Errors: kCancelled, kDeadlineExceeded.
  static Result<LineTree> make(std::vector<StraightLine> lines, const ExecutionContext& context);

  // In the order of the leaves.
  const std::vector<StraightLine>& lines() const { return lines_; }

  struct Nearest {
    double square;       // of the distance: the least of StraightLine::square over all lines
    std::uint32_t line;  // of lines(), one of those that are so near
    std::size_t looks;   // how many boxes and lines it took
  };
  // `guess` is any line; the nearer, the faster. REQUIRES: a point whose square is finite.
  Nearest nearest(Point p, std::uint32_t guess) const noexcept;

  // A number for each of lines(), and the least of those below each node.
  struct Numbers {
    std::vector<double> of_line;
    std::vector<double> of_node;
    std::size_t bytes() const noexcept {
      return (of_line.capacity() + of_node.capacity()) * sizeof(double);
    }
  };
  Numbers with_leasts(std::vector<double> of_line) const;
  // The least number of the lines within `distance` of p, perhaps of some that are farther;
  // infinity if there is none.
  double least_near(const Numbers& numbers, Point p, double distance) const noexcept;

  std::size_t bytes() const noexcept;

 private:
  static constexpr std::uint32_t kLeafSize = 8;  // lines at most
  static constexpr int kMaxLevels = 26;

  // Points within the half lengths of `middle`, along (ex, ey) and across; empty if negative.
  struct TurnedBox {
    Point middle;
    double ex;
    double ey;
    double half_along;
    double half_across;
  };
  struct Range {
    std::uint32_t first;
    std::uint32_t count;
  };

  void split(Range& range, Range* halves);
  TurnedBox box_around(std::size_t first, std::size_t end) const;
  static double least(const TurnedBox& box, Point p) noexcept;

  std::vector<StraightLine> lines_;
  std::vector<TurnedBox> boxes_;      // of node i, the root 1; its children 2i and 2i + 1
  std::vector<std::uint32_t> first_;  // line of each leaf, and the end
};

}  // namespace weft

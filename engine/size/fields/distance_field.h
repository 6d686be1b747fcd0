// SPDX-License-Identifier: Apache-2.0
// The distance to the nearest of many lines, in the unit of the coordinates. It is defined at every
// point of the plane, in and outside the box that it is made for.
//
// Exact: the value at a point is the least of what one formula gives for each line, so no bit of it
// depends on how the nearest one is found. The law that a test can check: the value with many lines
// is the least of the values with one line each and the same box, bit for bit. Rounding is at most
// 2^-48 of the distance, the longest line and the box's side together. Lines that agree to 2^-42 of
// the box's side, or of their distance from its centre if that is larger, may count as one.
//
// How: a quadtree over the box, whose leaves list every line that is nearest to some point of the
// leaf, and few others, if the domain meets it. A line s is dropped from a box if one point q of
// another line is nearer than all of s from the box's four corners: the points nearer to q than to
// s, by a margin or none, are an intersection of convex sets, so they hold the box if they hold its
// corners. Where lists stay long (pieces of one straight line, lines that cross at one point, a
// circle around its centre), and outside the box, a tree of turned boxes (line_tree.h) finds the
// nearest. A subtree lists no more than its share of kListedPerLine entries for each line, so the
// memory and time to build are bounded for any lines.
//
// Infinity if the square of the distance overflows: 1e150 sides of the box away. NaN at NaN.
//
//   Result<DistanceField> coast = DistanceField::make(lines, box, context);
//   double d = (*coast)({0.5, 0.5});
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/context.h"
#include "engine/size/domain_cover.h"
#include "engine/size/field.h"
#include "engine/size/fields/line_tree.h"

namespace weft {

struct Line {
  Point a;
  Point b;  // a for a point
};

class DistanceField final : public Field {
 public:
  // What `make` takes at most for some fields that have so many lines together.
  static constexpr std::uint64_t bytes_to_make(std::uint64_t lines, std::uint64_t fields = 1) {
    constexpr std::uint64_t kMega = std::uint64_t{1} << 20;
    return 256 * lines + std::min(kMega * fields + 512 * lines, 4 * kMega * fields);
  }
  static constexpr std::size_t kMaxLines = std::size_t{1} << 27;

  // `cover` is where the field is asked for most: the domain's; elsewhere a value takes longer.
  // REQUIRES: one line at least; finite coordinates of magnitude up to 1e50; a box that is not
  // empty. The same field on any number of threads.
  // Errors: kLimitExceeded for more than kMaxLines; kBudgetExceeded; kCancelled,
  // kDeadlineExceeded.
  static Result<DistanceField> make(std::vector<Line> lines, const DomainCover& cover,
                                    const ExecutionContext& context);

  void evaluate(std::size_t n, const double* x, const double* y,
                double* out) const noexcept override;

  // The value at the middle, and half the diagonal to either side: as tight as rounding allows for
  // a box that is small beside its distance.
  Interval bounds(const Box& box) const noexcept override;

  double steepness(const Box&) const noexcept override { return 1; }

  // The lines as they are held, with the rounding of the class, and numbers of theirs.
  std::vector<Line> lines() const;
  LineTree::Numbers with_leasts(std::vector<double> of_line) const {
    return tree_.with_leasts(std::move(of_line));
  }
  struct Near {
    Interval bounds;  // of the distance over a box
    double least;     // number of the lines nearest to some point of the box, and of some others
  };
  Near near(const LineTree::Numbers& numbers, const Box& box) const noexcept;

  // 1 everywhere, because it is but for a set without area.
  std::unique_ptr<const Field> slope() const override;

  std::size_t bytes() const noexcept override;
  std::size_t operations() const noexcept override { return operations_; }

 private:
  friend class ListBuilder;

  static constexpr double kRounding = 0x1p-46;  // of lengths; more than all roundings together
  static constexpr int kMaxDepth = 22;          // of the quadtree
  static constexpr int kMaxTopLevels = 8;
  static constexpr std::uint32_t kInner = 0xffffffffu;
  static constexpr std::uint32_t kByTree = 0xfffffffeu;  // a leaf without a list

  struct Node {
    std::uint32_t first;  // of its four children, or of its list; of kByTree a line that is near
    std::uint32_t count;  // of its list, or kInner, or kByTree
  };
  struct Lanes {
    __m128d x[4];
    __m128d y[4];
  };

  // All that follows is in the coordinates (x - centre) * scale, which are about 1 in the box.
  explicit DistanceField(const Box& box);
  Point inside(Point p) const { return {(p.x - centre_.x) * scale_, (p.y - centre_.y) * scale_}; }
  Point outside(Point p) const { return {p.x * unit_ + centre_.x, p.y * unit_ + centre_.y}; }
  Box outside(const Box& box) const {
    const Point low = outside(Point{box.min_x, box.min_y});
    const Point high = outside(Point{box.max_x, box.max_y});
    return {low.x, low.y, high.x, high.y};
  }
  std::optional<Error> add_quadtree(const DomainCover& cover, const ExecutionContext& context);
  void fill_table(std::uint32_t node, int depth, std::uint32_t ix, std::uint32_t iy);
  std::uint32_t leaf(int ix, int iy) const noexcept;
  void eight(const Lanes& at, __m128d* out) const noexcept;
  double one(Point p) const noexcept;  // REQUIRES: coordinates up to 2^500
  // Around the middle of a box, in the coordinates inside: `least` and `most` of the distance, with
  // its rounding.
  struct Around {
    Point middle;
    double radius;
    double least;
    double most;
  };
  Around around(const Box& box) const noexcept;
  Interval bounds_of(const Around& at) const noexcept;

  Point centre_;
  double scale_ = 1;  // a power of two
  double unit_ = 1;   // 1 / scale_
  double root_ = 0;   // half the side of the quadtree's root
  double cells_ = 0;  // of the last level, for each unit
  double longest_ = 0;
  LineTree tree_;
  int top_levels_ = 0;       // that the table skips
  std::vector<Node> nodes_;  // the root first
  std::vector<std::uint32_t> lists_;
  std::vector<std::uint32_t> table_;  // node of each cell of a level, or the leaf above it
  std::size_t operations_ = 0;
};

}  // namespace weft

// SPDX-License-Identifier: Apache-2.0
// A quadtree of boxes over the domain, with bounds of the grading function in each.
//
// It serves twice:
//   - No feature of the grading function is missed. A triangle's centroid may miss a fine spot
//     that the triangle covers; the map knows the spot. A box is split until the function is known
//     in it to a factor kResolved, or the box is about as small as the triangles there. A triangle
//     is too large, too, when it is larger than kFeatureFactor times the function's upper bound in
//     any box that it overlaps.
//   - Where the bounds agree, the function need not be evaluated. With the step function of the
//     cylinder model, 6 % of the rings are evaluated (bench/README.md).
//
// Bounds hold bit for bit for what SizeFunction::evaluate returns (interval arithmetic), so the map
// saves evaluations and changes no decision of the rest.
//
// Boxes that do not meet the domain are not looked at: a function that reaches 0 in a hole does no
// harm. Thread-safety: immutable once built.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "engine/base/context.h"
#include "engine/base/geometry.h"
#include "engine/domain/domain.h"
#include "engine/size/size_function.h"
#include "weft/error.h"

namespace weft {

class SizeMap {
 public:
  static constexpr double kResolved = 2;
  static constexpr double kFeatureFactor = 4;
  // A box is not split below this many times the area of the triangles there: a spot that spans
  // seven of their edges holds a whole box.
  static constexpr double kSmallBox = 16;
  static constexpr std::size_t kMaxNodes = std::size_t{1} << 16;

  struct Node {
    double lo;  // the function's bounds in the box
    double hi;
    double lowest_hi;           // least `hi` of the leaves below that meet the domain
    std::uint32_t first_child;  // of four, in Morton order; 0 for a leaf
    bool may_be_nan;
    bool meets_domain;

    bool leaf() const { return first_child == 0; }
    // Everywhere the same value, and one that a size may have.
    bool constant() const {
      return lo == hi && lo > 0 && hi < std::numeric_limits<double>::infinity() && !may_be_nan;
    }
  };

  // A node and its box, the outer sides stretched to infinity.
  struct Place {
    const Node* node;
    Box box;
  };

  // Errors: kCancelled, kDeadlineExceeded.
  static Result<SizeMap> build(const SizeFunction& size, const Domain& domain,
                               const ExecutionContext& context);

  // The smallest node whose box holds `box`.
  Place locate(const Box& box) const;

  // The function's value where it is constant in all of the box. `place` is
  // locate(box).
  std::optional<double> uniform_size(const Place& place, const Box& box) const;
  std::optional<double> uniform_size(const Box& box) const {
    return uniform_size(locate(box), box);
  }

  // Whether a triangle of this area overlaps a box below `place` where the function is less than
  // area / kFeatureFactor for certain.
  bool covers_finer(const Place& place, const std::array<Point, 3>& corners, double area) const;

  // The integral of 1 / size over the domain, which is the number of triangles that are as large as
  // they may be: a lower bound, by the upper bounds on the size, and the expected value.
  double triangles_lower_bound() const { return triangles_lower_bound_; }
  double expected_triangles() const { return expected_triangles_; }

  // The function's expected value at a point of the domain: the geometric mean of its bounds there.
  double expected_size(Point p) const;

  std::size_t bytes() const { return nodes_.capacity() * sizeof(Node); }

 private:
  Box inside_root(const Box& box) const;
  // Whether the leaves below `node`, whose box is `at`, that meet `box` all have the value `size`;
  // 0 stands for any and becomes the first one's.
  bool uniform_below(const Node& node, const Box& at, const Box& box, double& size) const;
  bool finer_below(const Node& node, const Box& at, const std::array<Point, 3>& corners,
                   double area) const;

  Box root_;
  std::vector<Node> nodes_;
  double triangles_lower_bound_ = 0;
  double expected_triangles_ = 0;
};

}  // namespace weft

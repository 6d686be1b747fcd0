// SPDX-License-Identifier: Apache-2.0
// The places that a limit to the growth of a size starts from.
//
// The length of edges h may grow by at most G per unit of length. The exact limit is
//   h_G(p) = min over q in the domain of h(q) + G |p - q|.
// Only those q matter at which h grows faster than G. A source is a box with a lower bound `edge`
// of h in it; edge + G * (distance to the box) is below the cone of each q in it, by at most G
// times the box's diagonal. The sources are the leaves of a quadtree. A box of it is
//   - dropped, if h grows by at most G all over it: from a q in it, a walk towards p meets no value
//     above q's cone, until it comes to p or to another box;
//   - dropped, if all of it lies above the cone of a sample: a point of the domain whose h is
//   known;
//   - a source, if G times its diagonal is at most kTolerance times `edge`, or what `edge` is below
//     the longest of its samples and G times half a side together: where the size changes little,
//     that leaves an eighth of the boxes;
//   - else divided in four.
// A walk may lead across boxes outside the domain, which can be no sources. One of them is dropped
// for these reasons, too, or if no walk that counts crosses it: because it lies outside the convex
// hull, or so far from the domain that a cone which has come back is above all sizes. If one is
// left where h grows by more than G, or has no value, boxes on the border of the domain are not
// dropped for the first reason. A storm surge's grid of 600,000 triangles, whose size is steep far
// inland, takes 0.05 s then; with its border as sources, it took 4.6 s.
//
// So at each point of the domain the least of the sources' cones and of h itself is never above
// the exact limit, but for rounding, and at most kTolerance below it. Two exceptions, both for
// sizes that no mesh follows: sources that are still too large at kMaxSources or kMaxDepth are left
// so, which makes the limit lower; and of boxes there that may reach 0, only a sample counts.
//
// Deterministic at any number of threads. Immutable once built.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/base/context.h"
#include "engine/base/geometry.h"
#include "engine/domain/domain.h"
#include "engine/size/size_function.h"
#include "weft/error.h"

namespace weft {

class SourceTree {
 public:
  static constexpr double kTolerance = 0.04;
  // A source is no smaller than this share of its edge, which a mesh cannot resolve.
  static constexpr double kSmallest = 0.02;
  static constexpr int kMaxDepth = 48;
  static constexpr std::size_t kMaxSources = std::size_t{1} << 20;

  struct Node {
    Box box;      // around all sources below
    double edge;  // their least
    std::uint32_t first_child;
    std::uint32_t children;  // next to one another; 0: a source

    bool source() const { return children == 0; }
    double diagonal() const;
  };

  // REQUIRES: gradation > 0 and finite. Errors: those of the context.
  static Result<SourceTree> build(const SizeFunction& size, double gradation, const Domain& domain,
                                  const ExecutionContext& context);

  bool empty() const { return nodes_.empty(); }
  // The first is the root.
  const std::vector<Node>& nodes() const { return nodes_; }
  std::size_t sources() const;
  std::size_t bytes() const { return nodes_.capacity() * sizeof(Node); }

 private:
  std::vector<Node> nodes_;
};

}  // namespace weft

// SPDX-License-Identifier: Apache-2.0
// The quadtree that guides refinement (the paper's Section 2.4): each leaf holds about the same
// number of triangles of the final mesh, so the tree follows the grading.
//
// It is built from samples of the mesh, so the grading function outside the domain has no effect.
// A node is split while its samples weigh more than the target; then nodes are split until sides
// of leaves that touch differ by at most a factor of two.
//
// Leaves are numbered as a sweep over the domain meets their middles, because the mesh is sent in
// this order (leaf_order.h). A line across the sweep cuts leaves that must be in memory at the same
// time, so the sweep goes in the direction in which the largest weight of these is smaller.
//
// The buffer zone around a leaf is half as wide as the leaf; where smaller leaves share a side with
// it, half as wide as these. The coarse mesh follows the smaller leaves there (leaf_radius.h), so a
// wider zone would defer no less, and would have the leaf wait for more of them.
//
// Borders between boxes are computed from integers, so boxes that touch share the same doubles.
//
// Units: coordinates of the domain; weights are triangles of the final mesh. Thread-safety:
// immutable once built.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/geometry.h"
#include "weft/error.h"

namespace weft {

class Quadtree {
 public:
  // A point of the domain, and the number of triangles of the final mesh that it represents.
  struct Sample {
    Point at;
    double weight;
  };

  static constexpr unsigned kMaxDepth = 31;  // limit of Morton codes of 64 bits

  struct Leaf {
    Box box;         // half-open
    Box halo;        // with the buffer zone around it
    double weight;   // of the samples in it
    unsigned depth;  // its side is that of the square over 2^depth
    // Its position among the squares of its depth, in the direction of the sweep and across it.
    std::uint32_t along, across;
    double side() const { return box.max_x - box.min_x; }
  };

  // Called with a number of leaves before there are so many, the more often the more there are;
  // returns the error to stop with, if they would take too much.
  using MayHave = std::function<std::optional<Error>(std::uint64_t leaves)>;

  // Builds the tree over a square that contains `domain`. A leaf weighs at most `target`, unless it
  // has only one sample or is 2^31 times smaller than the square. Errors: those of `may_have`.
  static Result<Quadtree> build(const Box& domain, std::vector<Sample> samples, double target,
                                const MayHave& may_have);
  static Quadtree build(const Box& domain, std::vector<Sample> samples, double target) {
    return *build(domain, std::move(samples), target,
                  [](std::uint64_t) { return std::optional<Error>(); });
  }

  // In the order of the sweep.
  const std::vector<Leaf>& leaves() const { return leaves_; }
  // The square. REQUIRES: built.
  Box box() const { return box_; }
  // Index of the leaf at a point; of a leaf near by if the point lies outside the square.
  std::uint32_t leaf_at(Point p) const;
  // The other leaves whose boxes touch that of a leaf, in order.
  std::vector<std::uint32_t> touching(std::uint32_t leaf) const;
  // Calls f(leaf) in any order for the leaves whose halos overlap the open `box`.
  template <class F>
  void for_overlapping(const Box& box, F&& f) const {
    const auto visit = [&](auto& self, const Node& node) -> void {
      if (!(node.halo.min_x < box.max_x && box.min_x < node.halo.max_x &&
            node.halo.min_y < box.max_y && box.min_y < node.halo.max_y)) {
        return;
      }
      if (node.first_child == 0) return f(node.leaf);
      for (std::uint32_t child = 0; child < 4; ++child)
        self(self, nodes_[node.first_child + child]);
    };
    visit(visit, nodes_.front());
  }
  // Per leaf, the others whose halos overlap its own, in order.
  std::vector<std::vector<std::uint32_t>> overlapping() const;

  std::size_t bytes() const {
    return nodes_.capacity() * sizeof(Node) + leaves_.capacity() * sizeof(Leaf);
  }

 private:
  struct Node {
    Point middle;
    Box halo;                   // contains the halos of all leaves below
    std::uint32_t first_child;  // of four, in Morton order; 0 for a leaf
    std::uint32_t leaf;         // its index, for a leaf
  };

  void sweep();

  Box box_;
  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;
};

}  // namespace weft

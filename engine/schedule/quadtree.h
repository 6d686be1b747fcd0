// SPDX-License-Identifier: Apache-2.0
// The quadtree that guides refinement (the paper's Section 2.4): each leaf holds about the same
// number of triangles of the final mesh, so the tree follows the grading.
//
// It is built from samples of the mesh, never from the grading function where there is no domain.
// A node is split while its samples weigh more than the target; then nodes are split until sides
// of leaves that touch differ by a factor of two at most.
//
// Borders between boxes are computed from integers, so boxes that touch share the same doubles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/geometry.h"

namespace weft {

class Quadtree {
 public:
  // A place of the domain and how many triangles of the final mesh it stands for.
  struct Sample {
    Point at;
    double weight;
  };

  struct Leaf {
    Box box;        // half-open
    Box grown;      // by half of its side in each direction
    double weight;  // of the samples in it
    double side() const { return box.max_x - box.min_x; }
  };

  // Over a square that holds `domain`. A leaf weighs at most `target`, unless it has one sample
  // alone or is 2^31 times smaller than the square.
  static Quadtree build(const Box& domain, std::vector<Sample> samples, double target);

  // In Morton order.
  const std::vector<Leaf>& leaves() const { return leaves_; }
  // The square. REQUIRES: built.
  Box box() const { return box_; }
  // Index of the leaf at a point; of one near by where the point lies outside the square.
  std::uint32_t leaf_at(Point p) const;
  // The other leaves whose boxes touch that of a leaf, in order.
  std::vector<std::uint32_t> touching(std::uint32_t leaf) const;
  // Per leaf, the others whose grown boxes overlap its own, in order.
  std::vector<std::vector<std::uint32_t>> conflicts() const;

  std::size_t bytes() const {
    return nodes_.capacity() * sizeof(Node) + leaves_.capacity() * sizeof(Leaf);
  }

 private:
  struct Node {
    Point middle;
    Box grown;                  // holds the grown boxes of all leaves below
    std::uint32_t first_child;  // of four, in Morton order; 0 for a leaf
    std::uint32_t leaf;         // its index, for a leaf
  };

  Box box_;
  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;
};

}  // namespace weft

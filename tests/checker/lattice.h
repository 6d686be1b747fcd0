// SPDX-License-Identifier: Apache-2.0
// Hand-made meshes with known properties, to be judged as they are and broken.
//
// Lattice point (i, j) lies at (i + j / 2, j). Cell (i, j) is the parallelogram from (i, j) to
// (i + 1, j + 1), cut by its short diagonal from (i + 1, j) to (i, j + 1). The triangles have area
// 1/2, angles of 53.1 to 63.4 degrees, and are strictly Delaunay. All coordinates are exact.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <ostream>
#include <set>
#include <utility>
#include <vector>

#include "checker/check.h"

namespace weft::check {

// How a failed expectation shows a rule.
inline void PrintTo(Rule rule, std::ostream* out) {
  *out << rule_name(rule);
}

}  // namespace weft::check

namespace weft::check::testing {

struct Problem {
  Domain domain;
  Mesh mesh;
  Requirements requirements;

  Report check() const { return weft::check::check(domain, mesh, requirements); }
};

// The rules that a report finds violated.
std::set<Rule> violated(const Report& report);

class Lattice {
 public:
  using Node = std::array<int, 2>;
  static Vec2 at(Node node) { return {node[0] + 0.5 * node[1], static_cast<double>(node[1])}; }

  explicit Lattice(int size) : size_(size) {}
  // A segment of the domain, along one of the three directions of lattice edges. It is a chain of
  // listed edges wherever those belong to the mesh.
  Lattice& segment(Node a, Node b, std::int32_t marker = 0);
  // The four sides of a block of cells.
  Lattice& box(Node low, Node high, std::int32_t marker = 0);
  Lattice& hole_seed_in_cell(Node cell);
  Lattice& region_in_cell(Node cell, std::int32_t id);
  // The mesh has the cells for which `keep` is true, with the region id that `region` says.
  Problem build(const std::function<bool(Node)>& keep,
                const std::function<std::int32_t(Node)>& region = {}) const;

 private:
  struct Side {
    Node a, b;
    std::int32_t marker;
  };
  int size_;
  std::vector<Side> sides_;
  std::vector<Vec2> holes_;
  std::vector<RegionSeed> regions_;
};

// The block of size x size cells, marker 1 all around; bounds that it just satisfies.
Problem block(int size);
// The block of 6 x 6 cells with the middle 2 x 2 cells a hole, marker 2 around it.
Problem block_with_hole();
// The block of 6 x 6 cells with a line, marker 3, that cuts it in two: region 10 below, 20 above.
Problem block_with_regions();

// The index of the listed edge between two places, or of the triangle with a corner at each.
std::size_t listed_edge(const Mesh& mesh, Vec2 p, Vec2 q);
std::size_t triangle(const Mesh& mesh, Vec2 p, Vec2 q, Vec2 r);
std::uint32_t vertex(const Mesh& mesh, Vec2 p);
// Removes triangle t, and vertices that no triangle has any more.
void remove_triangle(Mesh& mesh, std::size_t t);

}  // namespace weft::check::testing

// SPDX-License-Identifier: Apache-2.0
// Arcs and segments that leave a common vertex in one direction, as circles that touch do. However
// short their edges are, the hulls of some meet there.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "checker/domain/arc_chains.h"
#include "checker/edges/listed_edges.h"
#include "checker/mesh.h"

namespace weft::check {

class TangentCurves {
 public:
  // What is not listed counts for nothing. The arguments outlive this.
  TangentCurves(const ArcChains& chains, const Mesh& mesh, const ListedEdges& listed);

  // Whether the chord, and a listed edge, or a vertex, are of such curves, and beside each other:
  // arcs turn by no more than an edge may from the common vertex to there.
  bool have_edge(const ArcChains::Chord& chord, std::uint32_t edge) const;
  bool have_vertex(const ArcChains::Chord& chord, std::uint32_t vertex) const;

 private:
  // How a curve leaves a vertex.
  struct Leaving {
    std::uint32_t vertex;
    std::uint32_t segment;  // of the arc; kStraight
    Vec2 direction;         // of length 1
    double angle;           // of the vertex on the arc
    bool forward;           // along the arc
  };
  struct Pair {
    Leaving arc, other;
  };
  static constexpr std::uint32_t kStraight = 0xffffffffu;

  static bool holds(const Leaving& leaving, double from_angle, double to_angle);
  bool is_on_line(const Leaving& leaving, std::uint32_t vertex) const;
  template <class IsOn>
  bool any_other(const ArcChains::Chord& chord, IsOn&& is_on) const;

  const ArcChains& chains_;
  const Mesh& mesh_;
  std::vector<Pair> pairs_;                                        // by the segment of the arc
  std::vector<std::pair<std::uint32_t, std::uint32_t>> chord_of_;  // of edges; sorted
};

}  // namespace weft::check

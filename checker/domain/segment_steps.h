// SPDX-License-Identifier: Apache-2.0
// The listed edges of a mesh that lie on segments, and paths of them along one segment.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "checker/domain.h"
#include "checker/domain/tolerance.h"
#include "checker/edges/listed_edges.h"
#include "checker/mesh.h"

namespace weft::check {

// A listed edge within the tolerance of a segment, directed along it as an arrangement does: from
// the lexicographically smaller end.
struct Step {
  std::uint32_t segment;
  double from_position, to_position;
  std::uint32_t from, to;      // mesh vertices
  std::uint32_t edge;          // listed edge
  bool is_of_another = false;  // whether it lies on another segment, and this one is beside it
  auto key() const { return std::tie(segment, from_position, to_position, edge); }
};

// Measures along a segment from its lexicographically smaller end.
Track track_of(const Domain& domain, std::uint32_t segment);

// Sorted by key. An edge near several segments is a step of each. `tolerances`: one per segment.
std::vector<Step> steps_along_segments(const Domain& domain, const Mesh& mesh,
                                       const ListedEdges& listed,
                                       std::span<const double> tolerances);

struct Walk {
  std::vector<std::size_t> path;  // steps from start to goal, last first; empty if there is none
  std::uint32_t farthest;         // the reached vertex that is farthest along
};

// A path of the given steps of one segment, which are sorted, from one mesh vertex to another. Time
// and memory are linear in their number.
Walk walk(std::span<const Step> steps, std::uint32_t start, double start_position,
          std::uint32_t goal);

// The first pair, in the order of the starts, then of the goals, of different vertices that a path
// of the given steps joins; nullopt if there is none. Linear, too. REQUIRES: at most 64 starts.
std::optional<std::array<std::uint32_t, 2>> first_joined(std::span<const Step> steps,
                                                         std::span<const std::uint32_t> starts,
                                                         std::span<const std::uint32_t> goals);

}  // namespace weft::check

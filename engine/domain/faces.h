// SPDX-License-Identifier: Apache-2.0
// The faces of an arrangement and the graph of their neighbourhood.
//
// A face is a maximal set of triangles connected across edges without a constraint. The outside of
// the convex hull belongs to the unbounded face.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/domain/arrangement/arrangement.h"
#include "engine/domain/stop_poller.h"

namespace weft {

// Numbered from 0; kUnbounded is face 0.
struct Faces {
  static constexpr std::uint32_t kUnbounded = 0;
  std::vector<std::uint32_t>
      of_triangle;  // and a last one, which stands for what is beyond the hull
  std::uint32_t count = 1;
};

// Throws Stopped.
Faces find_faces(const Arrangement& arrangement, StopPoller& poller);

// The steps from each face into another one, across one constrained edge each.
class FaceGraph {
 public:
  struct Step {
    std::uint32_t from, to;    // faces
    std::uint32_t constraint;  // index into Arrangement::constraints
  };

  // Throws Stopped.
  FaceGraph(const Arrangement& arrangement, const Faces& faces, StopPoller& poller);

  std::span<const Step> from(std::uint32_t face) const {
    return std::span(steps_).subspan(first_[face], first_[face + 1] - first_[face]);
  }

 private:
  std::vector<std::size_t> first_;  // per face, and the end
  std::vector<Step> steps_;         // by `from`
};

}  // namespace weft

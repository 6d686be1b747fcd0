// SPDX-License-Identifier: Apache-2.0
// Small angles that the input forces. A triangle below the angle bound is exempt only if
//   - corner: its smallest angle is between two of its edges that are listed, and below 60 degrees:
//     the segments themselves meet at that angle; or
//   - shell: the two ends of its shortest edge lie on two different segments that meet in a vertex
//     V of the arrangement, see each other from V at less than 60 degrees, and are at the same
//     distance from V (concentric shells: G. L. Miller, S. E. Pav and N. J. Walkington, "When and
//     why Ruppert's algorithm works", 2003).
// Both hold to within rounding. The 60 degrees may be exceeded by 1e-9 in the cosine. The distances
// may differ by 2^-46 of the largest coordinate of the mesh, in absolute value: that is 128 units
// in the last place, twice what the engine allows itself. A tolerance relative to the distance,
// such as Triangle's 1e-3, would exempt angles of nearly 180 degrees if the segments are nearer to
// each other than that.
#pragma once

#include <cstdint>

#include "checker/domain.h"
#include "checker/edges/listed_edges.h"
#include "checker/mesh.h"
#include "checker/mesh/chains.h"

namespace weft::check {

enum class Exemption : std::uint8_t { kNone, kCorner, kShell };

class SmallInputAngles {
 public:
  SmallInputAngles(const Mesh& mesh, const ListedEdges& listed, SegmentsOfVertices segments);

  const SegmentsOfVertices& segments() const { return segments_; }

  // `corner` is that of the smallest angle, 0 to 2; the edge opposite is the shortest.
  Exemption exemption(std::uint32_t triangle, std::uint32_t corner) const;

 private:
  bool on_shell(std::uint32_t p, std::uint32_t q) const;
  bool is_shell(Vec2 v, Vec2 p, Vec2 q) const;

  const Mesh& mesh_;
  double same_distance_ = 0;  // the largest difference
  const ListedEdges& listed_;
  SegmentsOfVertices segments_;
  SegmentsOfVertices vertices_;  // reversed: (segment, vertex)
};

}  // namespace weft::check

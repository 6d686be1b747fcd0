// SPDX-License-Identifier: Apache-2.0
// The path of an arc through a mesh, along listed edges with both ends on the arc.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace weft::check {

// A listed edge with both ends on an arc, forward along it.
struct ArcStep {
  std::uint32_t arc;
  double from_angle, to_angle;  // as CircularArc has them
  std::uint32_t from, to;       // mesh vertices
  std::uint32_t edge;
  double off;     // how far its ends are from the arc
  double height;  // of the arc over it, above 0 if that is on the right of the edge as listed
};

struct ArcStop {
  double angle;
  std::optional<std::uint32_t> vertex;  // nullopt for an end of the arc that is not in the mesh
  const ArcStep* step;                  // that leads here; nullptr if none does
};

// From the one end of the arc to the other: with as little without steps as possible, and of as
// many steps as possible. `tolerance`: steps that are farther off do not count. `steps`: of this
// arc. The result refers to them.
std::vector<ArcStop> arc_path(std::span<const ArcStep> steps, double tolerance, double turn,
                              std::optional<std::uint32_t> from, std::optional<std::uint32_t> to);

}  // namespace weft::check

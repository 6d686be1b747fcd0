// SPDX-License-Identifier: Apache-2.0
// The path of a segment through a mesh in which near features have been merged: from the vertex
// that one end has become to that of the other, along listed edges beside the segment; of several
// paths, the one nearest to the segment. It may turn back by as much as it may run beside the
// segment, because the order of vertices as near as that is not defined. If the mesh has no edges
// because nothing beside the segment is meshed, the path jumps.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "checker/domain.h"
#include "checker/domain/tolerance.h"
#include "checker/mesh.h"
#include "checker/mesh/segment_steps.h"

namespace weft::check {

// Where an end of a segment is: in the mesh, or where it was.
struct ChainEnd {
  std::optional<std::uint32_t> vertex;  // of the mesh
  Vec2 at;
};

struct ChainStop {
  std::optional<std::uint32_t> vertex;  // of the mesh; nullopt for an end that is not in it
  Vec2 at;
  bool jumped = false;  // no listed edge leads here from the stop before
};

// All stops, from `from` to `to`. `steps` are the listed edges
// within `bend` of the segment, as steps_along_segments gives them. One stop if `from` and `to` are
// the same vertex. A path that runs beside the segment by more than the merging distance may belong
// to another segment: it is preferred to a jump only if `jumps_last`.
std::vector<ChainStop> bent_chain(const Mesh& mesh, const Track& track, std::span<const Step> steps,
                                  double bend, const ChainEnd& from, const ChainEnd& to,
                                  bool jumps_last);

}  // namespace weft::check

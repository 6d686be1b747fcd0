// SPDX-License-Identifier: Apache-2.0
// The path that a segment takes through a mesh in which features that are near have been merged:
// from the vertex that one end has become to that of the other one, along listed edges beside the
// segment. Of several paths, that one nearest to the segment. It may turn back by as little as it
// may run beside the segment: where vertices are as near to each other as that, forward is open.
// Where the mesh has no edges, because nothing beside the segment is meshed there, the path jumps.
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
  std::optional<std::uint32_t> vertex;  // of the mesh; none for an end that is not in it
  Vec2 at;
  bool jumped = false;  // no listed edge leads here from the stop before
};

// All stops, from `from` to `to`. `steps` are the listed edges
// within `bend` of the segment, as steps_along_segments gives them. One stop if `from` and `to` are
// the same vertex. A path that runs beside the segment by more than the merging distance may be
// that of another one: it is followed instead of jumping over it only if `jumps_last`.
std::vector<ChainStop> bent_chain(const Mesh& mesh, const Track& track, std::span<const Step> steps,
                                  double bend, const ChainEnd& from, const ChainEnd& to,
                                  bool jumps_last);

}  // namespace weft::check

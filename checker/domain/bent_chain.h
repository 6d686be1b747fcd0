// SPDX-License-Identifier: Apache-2.0
// The path of a segment through a mesh in which near features have been merged. It leads from the
// vertex that one end has become to that of the other, along listed edges beside the segment. If
// there are several paths, it is the one nearest to the segment. It may turn back, by no more than
// it may run beside the segment, because the order of vertices so close together is not defined. If
// the mesh has no edges because nothing beside the segment is meshed, the path jumps.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "checker/domain.h"
#include "checker/domain/segment_steps.h"
#include "checker/domain/tolerance.h"
#include "checker/mesh.h"

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

// When a path jumps. One that runs beside the segment by more than the merging distance may belong
// to another segment: it is preferred to a jump only from kLast on. The same holds of steps on
// another segment, and a longer jump.
enum class Jumps : std::uint8_t {
  kFree,
  kLast,      // if there is another path, it is taken; but one long jump is better than two
  kShortest,  // as kLast, but jumps are as short as they can be, however many
};

// All stops, from `from` to `to`; one if these are the same vertex. `steps` are the listed edges
// within `bend` of the segment, as steps_along_segments gives them.
std::vector<ChainStop> bent_chain(const Mesh& mesh, const Track& track, std::span<const Step> steps,
                                  double bend, const ChainEnd& from, const ChainEnd& to,
                                  Jumps jumps);

}  // namespace weft::check

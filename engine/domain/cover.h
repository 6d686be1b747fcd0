// SPDX-License-Identifier: Apache-2.0
// What the areas of a PSLG say of each face: whether one covers it, and its region and bound.
//
// A tour through the faces, from the unbounded one along a spanning tree and back, takes each area
// in and out as it crosses the area's border. As the borders are closed, also where merging has
// moved them, which areas cover a face does not depend on the way. Takes time in proportion to the
// faces and the borders that the tour crosses, with a logarithm of the areas that cover a face.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/domain/faces.h"
#include "engine/domain/stop_poller.h"
#include "weft/mesh.h"
#include "weft/pslg.h"

namespace weft {

struct Cover {
  std::uint32_t areas = 0;             // that cover the face, holes not counted
  bool is_hole = false;                // whether a hole covers it
  std::optional<std::int32_t> region;  // of the area that decides
  std::optional<double> max_area;      // the least bound
};

struct Covers {
  std::vector<Cover> of_face;
  Overlap overlap;
};

// REQUIRES: the arrangement of that PSLG; its arcs are no longer than pieces of chords.h. Throws
// Stopped.
Covers cover_faces(const Arrangement& arrangement, const Faces& faces, const FaceGraph& graph,
                   const Pslg& pslg, StopPoller& poller);

}  // namespace weft

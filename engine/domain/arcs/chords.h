// SPDX-License-Identifier: Apache-2.0
// Cuts the arcs of a PSLG into pieces, whose chords take their place in the triangulation.
//
// The hull of a piece is the triangle of its chord and the tangents at its ends. Afterwards,
//   - a piece turns by at most `max_turn`;
//   - hulls meet other hulls, segments, vertices and seeds at common ends alone, but for contacts.
// So chords meet as their arcs do, and however often pieces are cut later, wherever: the hull of a
// part lies in that of the whole. Refinement needs no other rule to keep the topology.
//
// Where an arc crosses a segment or an arc, both are cut; it is led through vertices nearer than
// the tolerance of merging (tolerance.h). Two pieces that hardly differ, as of an arc that was
// drawn twice, become one. Otherwise, while two hulls meet, the piece that is higher over its chord
// is halved.
//
// Pieces that leave a common vertex in one direction, to 1e-4 radians, are a contact: no number of
// cuts would keep their hulls apart. They end at one distance from the vertex, so that their chords
// lie as they do, and refinement keeps that order (Refiner::split_arc_at).
//
// The result depends on the PSLG and `max_turn` alone. Thread-safety: calls share nothing.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/domain/domain.h"
#include "engine/domain/stop_poller.h"
#include "weft/pslg.h"

namespace weft {

struct Chords {
  // The points of the input, then new ones; segments and arcs are pieces of those of the input.
  Pslg pslg;
  std::vector<std::uint32_t> segment;  // per segment of `pslg`: that of the input
};

// REQUIRES: a PSLG that `validate` accepts; max_turn, in radians, is at most pi / 2. Throws
// Stopped: kBadOption, kLimitExceeded, and what the poller throws.
Chords cut_arcs(const Pslg& pslg, double max_turn, StopPoller& poller);

// Tells a domain that was made of the chords of its arcs: sets Domain::curvatures, and names
// segments and points as the input does. Throws Stopped: kBadOption if merging has led an arc
// through a vertex, so that it is lost.
void restore_arcs(const Chords& chords, const Pslg& input, Domain& domain, StopPoller& poller);

}  // namespace weft

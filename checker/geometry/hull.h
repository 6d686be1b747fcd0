// SPDX-License-Identifier: Apache-2.0
// What may not come between a chord and its arc: the triangle of the chord and the point in which
// the tangents in its ends meet. All tests are exact, and of closed sets. Thread-safe.
#pragma once

#include "checker/domain.h"
#include "checker/geometry/box_tree.h"

namespace weft::check {

struct Hull {
  Vec2 from, to;  // the chord
  Vec2 corner;    // not collinear with it
};

Box box_of(const Hull& hull);

// Whether p lies in the hull, and is no end of the chord.
bool holds(const Hull& hull, Vec2 p);

// Whether an edge, or another hull, meets the hull elsewhere than in an end of the chords, or an
// edge, that both have. If they have both ends in common, they do not.
bool meet(const Hull& hull, Vec2 a, Vec2 b);
bool meet(const Hull& hull, const Hull& other);

}  // namespace weft::check

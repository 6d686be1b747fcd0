// SPDX-License-Identifier: Apache-2.0
// What sizes and pictures see of arcs. Units: coordinates of the domain. Thread-safety: pure
// functions.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/geometry.h"
#include "engine/domain/domain.h"
#include "weft/pslg.h"

namespace weft {

// Per segment, 0 if it is straight. REQUIRES: a PSLG that `validate` accepts.
std::vector<double> bulges_of(const Pslg& pslg);

// A PSLG without arcs: in their place, equal chords that turn by at most `turn`, in radians. Sizes
// that depend on the distance to segments are those of kFlatTurn. Arcs that `validate` refuses stay
// their chords.
inline constexpr double kFlatTurn = 0.034906585039886591;  // 2 degrees
Pslg flatten_arcs(const Pslg& pslg, double turn = kFlatTurn);

// How many chords take the place of arcs then, for kFlatTurn.
std::uint64_t count_chords(const Pslg& pslg);

// The box, with all places where arcs of the domain may have vertices.
Box box_with_arcs(const Domain& domain, Box box);

}  // namespace weft

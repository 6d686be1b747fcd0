// SPDX-License-Identifier: Apache-2.0
// Arcs of circles as SQL/MM and OGC 06-104r4 have them, by three points each: circular strings.
#pragma once

#include <span>
#include <string>

#include "files/formats/domain.h"
#include "files/formats/domains/biarcs.h"

namespace weft::files {

// Adds the arcs through positions 0, 1, 2, then through 2, 3, 4, and so on, to an empty chain. One
// that ends where it begins is a whole circle, through the point opposite, to the left. Positions
// that coincide make nothing; those of an arc on one line are a segment if the second lies between.
//
// Returns what is wrong, or "": the number of positions is even or 1; two of an arc coincide; they
// lie on one line, the second outside of the others.
std::string add_three_point_arcs(std::span<const Point> positions, ArcChain& chain);

// Adds a curve that goes on from the end of the chain, or begins an empty one. Returns what is
// wrong, or "": it begins elsewhere.
std::string append(const ArcChain& curve, ArcChain& chain);

}  // namespace weft::files

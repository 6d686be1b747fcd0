// SPDX-License-Identifier: Apache-2.0
// Bytes as a request to the engine: a small PSLG of the kinds that break meshers.
//
// Points stand on a grid of 2 to 16 lines, near earlier points, near segments between them, or
// beside each other on the arms of acute stars; "near" is a jitter of 1e-15 to 1e-3 grid steps. The
// grid may be turned by a Pythagorean angle, scaled, moved by up to 1e6, and rounded to decimals,
// as exports of floor plans are. Segments link them at random, so they cross, overlap and repeat.
// Then come seeds, a fill, and bounds of all kinds.
//
// The same bytes give the same case, on every machine.
#pragma once

#include <string>

#include "tests/fuzz/byte_source.h"
#include "weft/weft.h"

namespace weft::fuzz {

struct MeshCase {
  MeshRequest request{};
  Budget budget{};
  bool plain = false;  // nothing was rounded, nothing is to be merged
};

// What a case may take: beyond it the engine refuses or stops. The largest take about 40 ms with
// sanitizers, as much as a hundred others, so most cases with a size get the small budget.
inline constexpr std::uint64_t kMaxTriangles = 3000;
inline constexpr std::uint64_t kMaxBytes = 8 << 20;  // steep sizes build large trees
inline constexpr std::uint64_t kFewTriangles = 1000;
inline constexpr std::uint64_t kFewBytes = 2 << 20;  // less than a local width takes

MeshCase decode_mesh_case(ByteSource bytes);

// The case as a .poly file with its flags in comments, to 17 digits.
std::string to_text(const MeshCase& mesh_case);

}  // namespace weft::fuzz

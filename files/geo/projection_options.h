// SPDX-License-Identifier: Apache-2.0
// Whether a domain is in longitude and latitude, and in what its mesh is written.
#pragma once

#include <string>

namespace weft::files {

// In the plane, in metres: coordinates are multiples of kProjectedGrid, and features nearer
// together than kProjectedSnap are one, unless a request says another distance.
inline constexpr double kProjectedGrid = 0x1p-10;
inline constexpr double kProjectedSnap = 2 * kProjectedGrid;

struct ProjectionOptions {
  bool lonlat = false;     // the domain is in longitude and latitude
  std::string crs{};       // the projection, as PROJ names it; empty: one that suits the domain
  bool to_metres = false;  // the mesh is written in metres of the projection

  // Each of them says that the domain is in longitude and latitude.
  bool wanted() const { return lonlat || to_metres || !crs.empty(); }
};

}  // namespace weft::files

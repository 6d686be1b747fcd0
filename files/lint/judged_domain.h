// SPDX-License-Identifier: Apache-2.0
// A domain as it is to be judged: in a plane, each segment once.
#pragma once

#include "files/base/error.h"
#include "files/formats/domain.h"

namespace weft::files {

class JudgedDomain {
 public:
  // `lonlat`: the domain is in degrees, which are unrolled beyond the date line; if it goes around
  // all longitudes, it is judged in a plane around its pole. `of_mesh`: it was read from a mesh, so
  // a segment inside is listed twice (mesh_domain.h). Errors: those of lonlat_extent and of
  // flatten_arcs.
  static Result<JudgedDomain> make(const Domain& domain, bool lonlat, bool of_mesh);

  // Segments have the places of those of the file.
  const Domain& domain() const { return domain_; }
  // A place in the plane, as the file would have it.
  Point in_file(Point at) const;

 private:
  enum class Plane { kFile, kUnrolled, kNorth, kSouth };
  Domain domain_;
  Plane plane_ = Plane::kFile;
  double east_ = 0;  // the greatest longitude of the file
};

}  // namespace weft::files

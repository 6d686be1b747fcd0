// SPDX-License-Identifier: Apache-2.0
// A domain as it is to be judged: in a plane, each segment once.
//
// That of a domain in degrees is in metres. A line that is straight in degrees is straight there,
// so what touches in degrees does, to rounding; a projection bends it. In exchange, lengths are
// those on the ground at the middle latitude alone, or at a pole.
#pragma once

#include "files/base/error.h"
#include "files/formats/domain.h"

namespace weft::files {

class JudgedDomain {
 public:
  // `lonlat`: the domain is in degrees, which are unrolled beyond the date line; if it goes around
  // all longitudes, its plane is one around its pole. `of_mesh`: it was read from a mesh, so
  // a segment inside is listed twice (mesh_domain.h). Errors: those of lonlat_extent and of
  // flatten_arcs.
  static Result<JudgedDomain> make(const Domain& domain, bool lonlat, bool of_mesh);

  // Segments have the places of those of the file.
  const Domain& domain() const { return domain_; }
  // A place in the plane, as the file would have it; degrees to 1e-9.
  Point in_file(Point at) const;
  // At most so many metres on the ground are a metre in the plane; 1 if the file is in a plane.
  double greatest_length() const { return greatest_length_; }

 private:
  enum class Plane { kFile, kUnrolled, kNorth, kSouth };
  Domain domain_;
  Plane plane_ = Plane::kFile;
  double east_ = 0;    // the greatest longitude of the file
  double x_unit_ = 1;  // metres per degree of longitude, if unrolled
  double greatest_length_ = 1;
};

}  // namespace weft::files

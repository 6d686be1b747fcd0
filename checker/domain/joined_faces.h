// SPDX-License-Identifier: Apache-2.0
// The faces of a bent domain's arrangement, as far as they are certain. Links (gaps.h,
// bent_domain.h) divide faces. If the roles on both sides are the same, the faces count as one; but
// a sliver counts by itself, because the mesh need not have it. A face that merging may close is a
// sliver: it may have any role in the mesh, or be missing.
#pragma once

#include <cstdint>
#include <vector>

#include "checker/domain/bent_domain.h"
#include "checker/domain/fill.h"
#include "checker/domain/slivers.h"
#include "checker/geometry/arrangement.h"

namespace weft::check {

struct JoinedFaces {
  struct Face {
    double area = 0;
    double perimeter = 0;  // towards others: edges with the face on both sides do not count
    double slack = 0;      // the largest of the pieces and links there, at least rounding
  };
  std::vector<std::uint32_t> of;  // per face of the arrangement: the lowest one joined with it
  std::vector<Face> faces;        // of those lowest ones

  bool is_sliver(std::uint32_t face) const {
    const Face& f = faces[of[face]];
    return of[face] != 0 && f.area <= sliver_area(f.perimeter, f.slack);
  }
};

// REQUIRES: the arrangement of the bent domain and its links, and the roles of its faces.
JoinedFaces join_faces(const BentDomain& bent, const Arrangement& arrangement,
                       const std::vector<FaceRole>& roles);

}  // namespace weft::check

// SPDX-License-Identifier: Apache-2.0
// Arms that other segments cross. If two input segments, the arms, meet at a very small angle and a
// third crosses both, what lies beyond is as narrow as what lies before, but no two of its
// subsegments meet. So each subsegment beyond a crossing keeps the corner of its arm, as far as the
// other arm goes: it is split at distances from there, and triangles between it and the other arm
// are exempt as those at the corner are (acute_corners.h). Otherwise refinement would fill the
// strip with triangles as small as it is wide. 60 random wedges of 1e-2 to 1e-7 rad that are
// crossed once to four times have 27,000 triangles at 20 degrees, 51,000 at 30 and 72,000 at 33;
// without this, more than 18 million at each.
//
// Only corners below kSharp are kept, and for a subsegment only the sharpest on each of its sides:
// wider strips cost few triangles. An arm that has ended keeps nothing: in 150 rounded floor plans,
// the corners of such arms cost 5 % of the triangles.
//
// Errors: those of `find`. Thread-safety: immutable once found.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/context.h"
#include "engine/domain/domain.h"
#include "weft/error.h"

namespace weft {

class CrossedArms {
 public:
  // Tangent of the angle.
  static constexpr double kSharp = 0x1p-4;

  // A sector of the domain below kSharp: its corner and the subsegments on both sides.
  struct Sector {
    std::uint32_t corner;
    std::uint32_t subsegments[2];
    double tangent;
  };

  CrossedArms() = default;
  // Errors: kCancelled, kDeadlineExceeded.
  static Result<CrossedArms> find(const Domain& domain, const std::vector<Sector>& sectors,
                                  const ExecutionContext& context);

  // A subsegment, a corner of its arm that is none of its ends, and one of its ends.
  struct Arm {
    std::uint32_t subsegment;
    std::uint32_t corner;
    std::uint32_t end;
    float tangent;  // of the angle to the other arm
  };

  // The corners of a subsegment, each twice, once for each end.
  std::span<const Arm> of(std::uint32_t subsegment) const;
  // The arms that have an end at this vertex of the domain.
  std::span<const Arm> at(std::uint32_t vertex) const;
  // Whether one corner is kept for both subsegments.
  bool share_corner(std::uint32_t subsegment, std::uint32_t other) const;

  std::uint64_t bytes() const { return 2 * by_subsegment_.size() * sizeof(Arm); }

 private:
  std::vector<Arm> by_subsegment_;
  std::vector<Arm> by_end_;
};

}  // namespace weft

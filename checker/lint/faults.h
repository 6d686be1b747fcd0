// SPDX-License-Identifier: Apache-2.0
// What may be wrong with a domain before it is meshed: faults, each of a kind, with its place and
// the parts of the domain that make it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "checker/domain.h"

namespace weft::check {

enum class FaultKind : std::uint8_t {
  kOpenEnd,           // an end of a segment that no other segment touches
  kGap,               // an open end near another one, or near a segment; measure: the distance
  kCrossing,          // two segments cross at a point that is an end of neither
  kSelfCrossing,      // the same of one polygon's border
  kJunction,          // an end of a segment lies on the inside of another one
  kOverlap,           // two segments coincide in part; measure: the length
  kAreaOverlap,       // two polygons overlap, and none is inside the other; measure: the area
  kNearPoints,        // two points are near to each other; measure: the distance
  kNearSegment,       // a point is near to a segment; measure: the distance
  kSmallAngle,        // two segments meet at a small angle; measure: degrees
  kSliver,            // a face is far less wide than long; measure: the width
  kDuplicatePoint,    // a point is where another one is
  kDuplicateSegment,  // a segment has the ends of another one
  kZeroLength,        // the ends of a segment are one place
  kSeedOutside,       // a seed is in no bounded face
  kSeedOnSegment,     // a seed is on a segment
  kSeedShared,        // a seed has no effect because of another one in the same face
};
inline constexpr std::size_t kFaultKinds = 17;

std::string_view fault_name(FaultKind kind);  // "open-end"

// A part of a domain.
struct Offender {
  enum class What : std::uint8_t { kPoint, kSegment, kHole, kRegion, kArea };
  What what = What::kPoint;
  std::uint32_t index = 0;
  friend bool operator==(const Offender&, const Offender&) = default;
};

struct Fault {
  FaultKind kind = FaultKind::kOpenEnd;
  Vec2 at;
  std::optional<Vec2> to{};  // the other end, if it has a length
  std::vector<Offender> offenders{};
  double measure = 0;
};

// Counts all faults, and keeps the first of each kind.
class Faults {
 public:
  static constexpr std::uint64_t kMaxKept = 1000;  // of a kind

  void add(Fault fault) {
    if (totals_[static_cast<std::size_t>(fault.kind)]++ < kMaxKept)
      kept_.push_back(std::move(fault));
  }
  std::uint64_t total(FaultKind kind) const { return totals_[static_cast<std::size_t>(kind)]; }
  const std::vector<Fault>& kept() const { return kept_; }
  std::vector<Fault>& kept() { return kept_; }

 private:
  std::array<std::uint64_t, kFaultKinds> totals_{};
  std::vector<Fault> kept_;
};

}  // namespace weft::check

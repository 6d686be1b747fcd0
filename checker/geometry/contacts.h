// SPDX-License-Identifier: Apache-2.0
// Finds all pairs of segments that meet other than at their ends, exactly. A box tree proposes
// pairs, orientation tests decide them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "checker/domain.h"

namespace weft::check {

using SegmentEnds = std::array<std::uint32_t, 2>;  // indices into a list of points

// Maximum points where segments meet other than at their ends; a domain with more is not judged.
inline constexpr std::size_t kMaxContacts = 2'000'000;

struct Contacts {
  // A point, an end of some other segment, lies strictly inside the segment.
  struct Touch {
    std::uint32_t segment;
    std::uint32_t point;
  };
  // The insides of two segments meet in one point, an end of neither.
  struct Crossing {
    std::uint32_t first;
    std::uint32_t second;  // > first
  };
  // Two segments that overlap have an end of one inside the other, or the same ends: the former are
  // touches, the latter are no contact.
  std::vector<Touch> touches;  // may repeat
  std::vector<Crossing> crossings;
  bool complete = true;  // false: there are more than the limit, and the search ended
};

// REQUIRES: finite coordinates, valid indices, no segment of zero length.
Contacts find_contacts(std::span<const Vec2> points, std::span<const SegmentEnds> segments,
                       std::size_t limit);

}  // namespace weft::check

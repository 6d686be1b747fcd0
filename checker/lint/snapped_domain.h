// SPDX-License-Identifier: Apache-2.0
// A domain whose points within the merging distance of each other are one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "checker/domain.h"
#include "checker/geometry/box_tree.h"
#include "checker/geometry/contacts.h"

namespace weft::check {

struct SnappedDomain {
  std::vector<Vec2> places;              // in the order of the first points there
  std::vector<std::uint32_t> place_of;   // per point
  std::vector<std::uint32_t> point_at;   // per place: its first point
  std::vector<SegmentEnds> segments;     // of places; those with two ends at one are left out
  std::vector<std::uint32_t> origin;     // per segment: the domain's
  std::vector<std::uint32_t> areas;      // per segment: 0, or 1 + an index into the domain's areas
  std::vector<std::uint32_t> first_end;  // per place, and one more: where its ends start
  std::vector<std::uint32_t> ends;       // segments, by place
  std::vector<double> reach;  // per place: length of the shortest segment there; infinity: none
  double merging = 0;         // the merging distance
  double rounding = 0;        // the merging distance without a snap
  double extent = 0;          // the longer side of the box around all

  std::span<const std::uint32_t> segments_at(std::uint32_t place) const {
    return {ends.data() + first_end[place], ends.data() + first_end[place + 1]};
  }
  std::uint32_t other_end(std::uint32_t segment, std::uint32_t place) const {
    const auto [a, b] = segments[segment];
    return a == place ? b : a;
  }
  bool is_end(std::uint32_t segment, std::uint32_t place) const {
    return segments[segment][0] == place || segments[segment][1] == place;
  }
  Vec2 from(std::uint32_t segment) const { return places[segments[segment][0]]; }
  Vec2 to(std::uint32_t segment) const { return places[segments[segment][1]]; }
  double length(std::uint32_t segment) const;
};

// REQUIRES: a domain that judge_domain accepts.
SnappedDomain snapped(const Domain& domain);

BoxTree tree_of_segments(const SnappedDomain& snapped);

double distance(Vec2 p, Vec2 q);

}  // namespace weft::check

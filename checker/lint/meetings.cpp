// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "checker/domain/tolerance.h"
#include "checker/lint/rules.h"

namespace weft::check {
namespace {

// In more than double precision, because lines may meet at a small angle.
Vec2 crossing_of(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  using Real = long double;
  const Real ux = Real{b.x} - a.x, uy = Real{b.y} - a.y;
  const Real vx = Real{d.x} - c.x, vy = Real{d.y} - c.y;
  const Real t = ((Real{c.x} - a.x) * vy - (Real{c.y} - a.y) * vx) / (ux * vy - uy * vx);
  return {static_cast<double>(a.x + t * ux), static_cast<double>(a.y + t * uy)};
}

// A crossing within the merging distance of an end is a junction there.
void judge_crossings(const LintContext& context, Faults& faults) {
  const SnappedDomain& snapped = context.snapped;
  for (const auto [s, t] : context.crossings) {
    if (context.of_two_areas(s, t)) continue;
    const std::array<Vec2, 4> ends = {snapped.from(s), snapped.to(s), snapped.from(t),
                                      snapped.to(t)};
    const Vec2 at = crossing_of(ends[0], ends[1], ends[2], ends[3]);
    if (std::any_of(ends.begin(), ends.end(),
                    [&](Vec2 end) { return distance(end, at) <= snapped.merging; }))
      continue;
    const bool of_one_area = snapped.areas[s] != 0 && snapped.areas[s] == snapped.areas[t];
    faults.add({.kind = of_one_area ? FaultKind::kSelfCrossing : FaultKind::kCrossing,
                .at = at,
                .offenders = {context.segment(s), context.segment(t)}});
  }
}

// Where the segment t, which has an end on s, runs along s: from that end on.
std::optional<Vec2> shared_until(const SnappedDomain& snapped, std::uint32_t s, std::uint32_t t,
                                 std::uint32_t place) {
  const double tolerance = snapped.merging;
  const Vec2 other = snapped.places[snapped.other_end(t, place)];
  if (Track(snapped.from(s), snapped.to(s)).carries(other, tolerance)) return other;
  const Track along(snapped.from(t), snapped.to(t));
  for (const Vec2 end : {snapped.from(s), snapped.to(s)})
    if (along.carries(end, tolerance)) return end;
  return std::nullopt;
}

void judge_touches(const LintContext& context, Faults& faults) {
  const SnappedDomain& snapped = context.snapped;
  std::map<std::pair<std::uint32_t, std::uint32_t>, bool> told;  // pairs that overlap
  for (const auto [s, place] : context.touches) {
    bool overlaps = false, meets = false;
    for (const std::uint32_t t : snapped.segments_at(place)) {
      if (const auto until = shared_until(snapped, s, t, place)) {
        overlaps = true;
        if (snapped.areas[s] != snapped.areas[t]) continue;
        if (!std::exchange(told[std::minmax(s, t)], true))
          faults.add({.kind = FaultKind::kOverlap,
                      .at = snapped.places[place],
                      .to = until,
                      .offenders = {context.segment(s), context.segment(t)},
                      .measure = distance(snapped.places[place], *until)});
      } else if (!context.of_two_areas(s, t)) {
        meets = true;
      }
    }
    if (meets && !overlaps)
      faults.add({.kind = FaultKind::kJunction,
                  .at = snapped.places[place],
                  .offenders = {context.point(place), context.segment(s)}});
  }
}

// Borders of two polygons may be one, and a line may lie on a border.
void judge_duplicate_segments(const LintContext& context, Faults& faults) {
  const SnappedDomain& snapped = context.snapped;
  std::vector<std::uint32_t> order(snapped.segments.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t s) {
    const auto [a, b] = std::minmax(snapped.segments[s][0], snapped.segments[s][1]);
    return std::array{a, b, snapped.areas[s], s};
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t s, std::uint32_t t) { return key(s) < key(t); });
  std::vector<std::array<std::uint32_t, 2>> pairs;
  for (std::size_t k = 1, first = 0; k < order.size(); ++k) {
    const auto one = key(order[first]), other = key(order[k]);
    if (std::equal(one.begin(), one.begin() + 3, other.begin()))
      pairs.push_back({order[k], order[first]});
    else
      first = k;
  }
  std::sort(pairs.begin(), pairs.end());
  for (const auto [s, t] : pairs)
    faults.add({.kind = FaultKind::kDuplicateSegment,
                .at = snapped.from(s),
                .to = snapped.to(s),
                .offenders = {context.segment(s), context.segment(t)}});
}

void judge_points_themselves(const LintContext& context, Faults& faults) {
  const Domain& domain = context.domain;
  for (std::uint32_t s = 0; s < domain.segments.size(); ++s) {
    const auto [a, b] = domain.segments[s];
    if (domain.points[a] == domain.points[b])
      faults.add({.kind = FaultKind::kZeroLength,
                  .at = domain.points[a],
                  .offenders = {{Offender::What::kSegment, s}}});
  }
  if (!context.shared_points) return;
  std::vector<std::uint32_t> order(domain.points.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto at = [&](std::uint32_t i) { return domain.points[i]; };
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    return at(i) == at(j) ? i < j : lexicographically_less(at(i), at(j));
  });
  std::vector<std::array<std::uint32_t, 2>> pairs;
  for (std::size_t k = 1, first = 0; k < order.size(); ++k) {
    if (at(order[k]) == at(order[first]))
      pairs.push_back({order[k], order[first]});
    else
      first = k;
  }
  std::sort(pairs.begin(), pairs.end());
  for (const auto [i, j] : pairs)
    faults.add({.kind = FaultKind::kDuplicatePoint,
                .at = at(i),
                .offenders = {{Offender::What::kPoint, i}, {Offender::What::kPoint, j}}});
}

}  // namespace

void judge_meetings(const LintContext& context, Faults& faults) {
  judge_points_themselves(context, faults);
  judge_crossings(context, faults);
  judge_touches(context, faults);
  judge_duplicate_segments(context, faults);
}

}  // namespace weft::check

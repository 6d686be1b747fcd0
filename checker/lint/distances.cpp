// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "checker/domain/tolerance.h"
#include "checker/lint/lint.h"
#include "checker/lint/rules.h"

namespace weft::check {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

BoxTree tree_of(const std::vector<Vec2>& points) {
  std::vector<Box> boxes;
  boxes.reserve(points.size());
  for (const Vec2 p : points) boxes.push_back(box_of(p, p));
  return BoxTree(std::move(boxes));
}

class EndJudge {
 public:
  EndJudge(const LintContext& context, Faults& faults)
      : context_(context), snapped_(context.snapped), faults_(faults) {}

  std::vector<char> judge() {
    std::vector<std::uint32_t> open;
    std::vector<char> is_open(snapped_.places.size(), 0);
    std::vector<Vec2> at;
    for (std::uint32_t place = 0; place < snapped_.places.size(); ++place) {
      if (!is_open_end(place)) continue;
      is_open[place] = 1;
      open.push_back(place);
      at.push_back(snapped_.places[place]);
    }
    const BoxTree tree = tree_of(at);
    std::vector<char> told(open.size(), 0);
    for (std::uint32_t k = 0; k < open.size(); ++k) {
      if (told[k]) continue;
      const auto end = nearest_end(k, open, tree);
      const auto segment = nearest_segment(open[k], end.distance);
      if (segment) {
        add_gap(open[k], *segment);
      } else if (end.found) {
        told[*end.found] = 1;
        add_gap_of_ends(open[k], open[*end.found]);
      } else if (!is_inside_a_polygon(open[k])) {
        faults_.add({.kind = FaultKind::kOpenEnd,
                     .at = at[k],
                     .offenders = {context_.segment(own(open[k]))}});
      }
    }
    return is_open;
  }

 private:
  struct Nearest {
    std::optional<std::uint32_t> found;
    double distance;
  };

  std::uint32_t own(std::uint32_t place) const { return snapped_.segments_at(place)[0]; }

  std::span<const std::uint32_t> half_edges(std::uint32_t place) const {
    return context_.arrangement->half_edges_at(context_.arrangement->vertices().of_point(place));
  }

  bool is_open_end(std::uint32_t place) const {
    return !snapped_.segments_at(place).empty() && half_edges(place).size() == 1;
  }

  // A line may end there: it is an edge of the mesh.
  bool is_inside_a_polygon(std::uint32_t place) const {
    return !context_.covering.empty() &&
           !context_.covering[context_.arrangement->face(half_edges(place)[0])].empty();
  }

  Nearest nearest_end(std::uint32_t k, const std::vector<std::uint32_t>& open,
                      const BoxTree& tree) const {
    const std::uint32_t place = open[k], other = snapped_.other_end(own(place), place);
    double least = kGapOfExtent * snapped_.extent;
    const auto found = tree.least(snapped_.places[place], 1, least, [&](std::uint32_t l) {
      return l == k || open[l] == other
                 ? kInfinity
                 : distance(snapped_.places[place], snapped_.places[open[l]]);
    });
    return {found, least};
  }

  // Nearer than `below`, by more than rounding, and than the end's own segment is long, so that a
  // bend of a line is no gap.
  std::optional<std::uint32_t> nearest_segment(std::uint32_t place, double below) const {
    const std::uint32_t other = snapped_.other_end(own(place), place);
    const Vec2 p = snapped_.places[place];
    double least = std::min(below * (1 - 0x1p-20), snapped_.length(own(place)));
    return context_.tree.least(p, 1, least, [&](std::uint32_t s) {
      return snapped_.is_end(s, place) || snapped_.is_end(s, other)
                 ? kInfinity
                 : distance(p, snapped_.from(s), snapped_.to(s));
    });
  }

  void add_gap(std::uint32_t place, std::uint32_t s) {
    const Vec2 p = snapped_.places[place];
    faults_.add({.kind = FaultKind::kGap,
                 .at = p,
                 .offenders = {context_.segment(own(place)), context_.segment(s)},
                 .measure = distance(p, snapped_.from(s), snapped_.to(s))});
  }

  void add_gap_of_ends(std::uint32_t place, std::uint32_t other) {
    const Vec2 p = snapped_.places[place], q = snapped_.places[other];
    faults_.add({.kind = FaultKind::kGap,
                 .at = p,
                 .to = q,
                 .offenders = {context_.segment(own(place)), context_.segment(own(other))},
                 .measure = distance(p, q)});
  }

  const LintContext& context_;
  const SnappedDomain& snapped_;
  Faults& faults_;
};

void judge_points(const LintContext& context, const std::vector<char>& is_open, Faults& faults) {
  const SnappedDomain& snapped = context.snapped;
  const std::vector<Vec2>& places = snapped.places;
  const std::vector<double>& reach = snapped.reach;
  const BoxTree tree = tree_of(places);
  std::vector<std::array<std::uint32_t, 2>> pairs;
  for (std::uint32_t p = 0; p < places.size(); ++p) {
    if (reach[p] == kInfinity) continue;  // of two points without segments, none is near
    double least = kNearOfLength * reach[p];
    const auto q = tree.least(places[p], 1, least, [&](std::uint32_t other) {
      const double d = distance(places[p], places[other]);
      return other != p && d < kNearOfLength * reach[other] ? d : kInfinity;
    });
    if (q && (is_open.empty() || !(is_open[p] || is_open[*q])))  // else a gap
      pairs.push_back({std::min(p, *q), std::max(p, *q)});
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  for (const auto [p, q] : pairs)
    faults.add({.kind = FaultKind::kNearPoints,
                .at = places[p],
                .to = places[q],
                .offenders = {context.point(p), context.point(q)},
                .measure = distance(places[p], places[q])});
}

// A segment that shares an end with one of the point's is a matter of their angle.
bool is_joined(const SnappedDomain& snapped, std::uint32_t place, std::uint32_t s) {
  const auto at = snapped.segments_at(place);
  return std::any_of(at.begin(), at.end(), [&](std::uint32_t t) {
    return snapped.is_end(s, snapped.other_end(t, place));
  });
}

void judge_points_and_segments(const LintContext& context, const std::vector<char>& is_open,
                               Faults& faults) {
  const SnappedDomain& snapped = context.snapped;
  for (std::uint32_t place = 0; place < snapped.places.size(); ++place) {
    if (!is_open.empty() && is_open[place]) continue;  // a gap if at all
    const Vec2 p = snapped.places[place];
    double least = kNearOfLength * std::min(snapped.reach[place], snapped.extent);
    const auto s = context.tree.least(p, 1, least, [&](std::uint32_t t) {
      const Vec2 a = snapped.from(t), b = snapped.to(t);
      const double d = distance(p, a, b);
      return d > snapped.merging && d < kNearOfLength * distance(a, b) && is_beside(p, a, b) &&
                     !snapped.is_end(t, place) && !is_joined(snapped, place, t)
                 ? d
                 : kInfinity;
    });
    if (s)
      faults.add({.kind = FaultKind::kNearSegment,
                  .at = p,
                  .offenders = {context.point(place), context.segment(*s)},
                  .measure = least});
  }
}

}  // namespace

bool is_beside(Vec2 p, Vec2 a, Vec2 b) {
  const Track track(a, b);
  const double position = track.position(p);
  return position > 0 && position < track.length();
}

double distance(Vec2 p, Vec2 a, Vec2 b) {
  return Track(a, b).distance(p);
}

std::vector<char> judge_ends(const LintContext& context, Faults& faults) {
  return EndJudge(context, faults).judge();
}

void judge_distances(const LintContext& context, const std::vector<char>& is_open, Faults& faults) {
  judge_points(context, is_open, faults);
  judge_points_and_segments(context, is_open, faults);
}

}  // namespace weft::check

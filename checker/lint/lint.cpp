// SPDX-License-Identifier: Apache-2.0
#include "checker/lint/lint.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "checker/domain/bent_domain.h"
#include "checker/domain/cover.h"
#include "checker/domain/gaps.h"
#include "checker/geometry/predicates.h"
#include "checker/lint/rules.h"

namespace weft::check {

std::string_view fault_name(FaultKind kind) {
  constexpr std::array<std::string_view, kFaultKinds> kNames = {
      "open-end",          "gap",         "crossing",     "self-crossing",
      "junction",          "overlap",     "area-overlap", "near-points",
      "near-segment",      "small-angle", "sliver",       "duplicate-point",
      "duplicate-segment", "zero-length", "seed-outside", "seed-on-segment",
      "seed-shared"};
  return kNames[static_cast<std::size_t>(kind)];
}

namespace {

// What joins places within the merging distance of the inside of segments to these; and those that
// rounding alone has put beside them.
struct Joints {
  std::vector<Contacts::Touch> touches;
  std::vector<std::array<Vec2, 2>> links;
  bool complete = true;
};

Joints find_joints(const SnappedDomain& snapped, const BoxTree& tree) {
  Joints out;
  for (std::uint32_t place = 0; place < snapped.places.size(); ++place) {
    if (snapped.segments_at(place).empty()) continue;
    const Vec2 p = snapped.places[place];
    tree.visit(box_of(p, p).grown(snapped.merging), [&](std::uint32_t s) {
      if (!out.complete || snapped.is_end(s, place)) return;
      const Vec2 a = snapped.from(s), b = snapped.to(s);
      const double d = distance(p, a, b);
      if (d > snapped.merging || !is_beside(p, a, b) || orientation(a, b, p) == 0) return;
      if (d <= snapped.rounding) out.touches.push_back({s, place});
      if (const auto q = across(p, a, b, d)) out.links.push_back({p, *q});
      out.complete = out.links.size() <= kMaxMeetings;
    });
    if (!out.complete) break;
  }
  return out;
}

void arrange(LintContext& context, Joints joints) {
  const SnappedDomain& snapped = context.snapped;
  std::vector<Vec2> points = snapped.places;
  std::vector<SegmentEnds> segments = snapped.segments;
  for (const auto& link : joints.links) {
    const auto first = static_cast<std::uint32_t>(points.size());
    points.insert(points.end(), link.begin(), link.end());
    segments.push_back({first, first + 1});
  }
  const Contacts contacts = find_contacts(points, segments, kMaxMeetings);
  context.touches = std::move(joints.touches);
  for (const auto [segment, point] : contacts.touches)
    if (segment < snapped.segments.size() && point < snapped.places.size())
      context.touches.push_back({segment, point});
  const auto order = [](const Contacts::Touch& touch) {
    return std::tie(touch.point, touch.segment);
  };
  std::sort(context.touches.begin(), context.touches.end(),
            [&](const auto& s, const auto& t) { return order(s) < order(t); });
  context.touches.erase(
      std::unique(context.touches.begin(), context.touches.end(),
                  [&](const auto& s, const auto& t) { return order(s) == order(t); }),
      context.touches.end());
  for (const Contacts::Crossing& crossing : contacts.crossings)
    if (crossing.second < snapped.segments.size()) context.crossings.push_back(crossing);
  std::sort(context.crossings.begin(), context.crossings.end(), [](const auto& s, const auto& t) {
    return std::tie(s.first, s.second) < std::tie(t.first, t.second);
  });
  if (!joints.complete || !contacts.complete) return;
  context.arrangement.emplace(points, segments, contacts, snapped.segments.size());
  if (context.domain.areas.empty()) return;
  BentDomain bent;
  bent.domain.segment_areas = snapped.areas;
  context.covering = covering_areas(bent, *context.arrangement);
}

}  // namespace

LintResult lint(const Domain& domain, bool shared_points) {
  SnappedDomain merged = snapped(domain);
  BoxTree tree = tree_of_segments(merged);
  Joints joints = find_joints(merged, tree);
  LintContext context{domain, shared_points, std::move(merged), std::move(tree)};
  arrange(context, std::move(joints));
  LintResult result;
  std::vector<char> is_open;
  if (context.arrangement) {
    is_open = judge_ends(context, result.faults);
    judge_faces(context, result.faults);
    judge_seeds(context, result.faults);
  }
  judge_meetings(context, result.faults);
  judge_distances(context, is_open, result.faults);
  result.complete = context.arrangement.has_value();
  std::stable_sort(result.faults.kept().begin(), result.faults.kept().end(),
                   [](const Fault& a, const Fault& b) { return a.kind < b.kind; });
  return result;
}

}  // namespace weft::check

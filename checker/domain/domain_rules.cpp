// SPDX-License-Identifier: Apache-2.0
#include "checker/domain/domain_rules.h"

#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "checker/text.h"

namespace weft::check {

bool is_usable(double coordinate) {
  const double magnitude = std::fabs(coordinate);
  return magnitude == 0 || (magnitude >= kMinMagnitude && magnitude <= kMaxMagnitude);
}

bool is_bulge(double bulge) {
  return std::fabs(bulge) <= 1e6;
}

namespace {

void judge_arcs(const Domain& domain, Findings& findings) {
  std::vector<char> is_arc(domain.segments.size(), 0);
  for (std::size_t i = 0; i < domain.arcs.size(); ++i) {
    const Arc& arc = domain.arcs[i];
    const auto bad = [&](auto&&... parts) {
      findings.add(Rule::kDomain, [&] { return say("arc ", i, parts...); });
    };
    if (arc.segment >= domain.segments.size()) {
      bad(" is of segment ", arc.segment, ", but there are ", domain.segments.size());
      continue;
    }
    if (is_arc[arc.segment]) bad(" is the second of segment ", arc.segment);
    is_arc[arc.segment] = 1;
    if (!is_bulge(arc.bulge)) bad(" has the bulge ", arc.bulge, ", of a magnitude beyond 1e6");
    const auto [a, b] = domain.segments[arc.segment];
    if (arc.bulge != 0 && a == b)
      bad(", of segment ", arc.segment, ", begins and ends at point ", a);
  }
}

}  // namespace

bool judge_domain(const Domain& domain, Findings& findings) {
  const auto bad = [&](auto&&... parts) {
    findings.add(Rule::kDomain, [&] { return say(parts...); });
  };
  const auto usable = [](Vec2 p) { return is_usable(p.x) && is_usable(p.y); };
  constexpr std::string_view kUnusable = ": not finite, or of a magnitude beyond 1e-150 to 1e150";

  for (std::size_t i = 0; i < domain.points.size(); ++i)
    if (!usable(domain.points[i])) bad("point ", i, " is at ", domain.points[i], kUnusable);
  for (std::size_t i = 0; i < domain.holes.size(); ++i)
    if (!usable(domain.holes[i])) bad("hole seed ", i, " is at ", domain.holes[i], kUnusable);
  for (std::size_t i = 0; i < domain.regions.size(); ++i) {
    const RegionSeed& seed = domain.regions[i];
    if (!usable(seed.at)) bad("region seed ", i, " is at ", seed.at, kUnusable);
    if (seed.max_area && !(*seed.max_area > 0))
      bad("region seed ", i, " has the area bound ", *seed.max_area, ", which is not positive");
  }
  for (std::size_t i = 0; i < domain.segments.size(); ++i) {
    const auto [a, b] = domain.segments[i];
    if (a >= domain.points.size() || b >= domain.points.size())
      bad("segment ", i, " joins points ", a, " and ", b, ", but there are ", domain.points.size());
  }
  judge_arcs(domain, findings);
  if (!domain.segment_areas.empty() && domain.segment_areas.size() != domain.segments.size()) {
    bad(domain.segment_areas.size(), " areas for ", domain.segments.size(), " segments");
    return false;
  }
  // Every area's segments close: an even number of their ends is at every point.
  std::set<std::pair<std::uint32_t, std::uint32_t>> open;  // area and point
  for (std::size_t i = 0; i < domain.segment_areas.size(); ++i) {
    const std::uint32_t area = domain.segment_areas[i];
    if (area > domain.areas.size())
      bad("segment ", i, " is of area ", area - 1, ", but there are ", domain.areas.size());
    if (area != 0)
      for (const std::uint32_t point : domain.segments[i])
        if (const auto [at, is_new] = open.emplace(area - 1, point); !is_new) open.erase(at);
  }
  for (const auto& [area, point] : open) bad("area ", area, " is open at point ", point);
  for (std::size_t i = 0; i < domain.areas.size(); ++i)
    if (domain.areas[i].max_area && !(*domain.areas[i].max_area > 0))
      bad("area ", i, " has the bound ", *domain.areas[i].max_area, ", which is not positive");
  if (!(domain.snap >= 0 && domain.snap <= kMaxMagnitude))
    bad("the merging distance ", domain.snap, " is not finite or below 0");
  if (!domain.markers.empty() && domain.markers.size() != domain.segments.size())
    bad(domain.markers.size(), " markers for ", domain.segments.size(), " segments");
  return findings.total(Rule::kDomain) == 0;
}

}  // namespace weft::check

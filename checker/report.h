// SPDX-License-Identifier: Apache-2.0
// The checker's findings: violations, each a sentence that names its offender, and measured facts.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "checker/domain.h"

namespace weft::check {

enum class Rule : std::uint8_t {
  kDomain,       // the domain itself is well formed, so that a mesh of it can be judged
  kSize,         // the size expression parses, and is positive and finite at every centroid
  kStructure,    // indices in range, three distinct corners, usable coordinates, no idle vertex
  kOrientation,  // every triangle is strictly counter-clockwise
  kConformity,   // an edge has at most two triangles, one on each side
  kOverlap,      // no point of the plane is covered twice
  kEdges,     // the edges listed are those mesh edges that lie on segments, the boundary among them
  kChains,    // every segment that borders or lies in the domain is a chain of listed edges; that
              // of an arc is near it (mesh/arc_rules.h)
  kPoints,    // every input point in the domain is a vertex
  kMarkers,   // a listed edge carries the marker of its segment
  kCoverage,  // the triangles cover the domain, all of it and nothing else
  kRegions,   // a triangle carries the id of the region that it lies in
  kDelaunay,  // across every unlisted edge, no corner lies inside the other circumcircle
  kAngle,     // no angle is below the bound, except those that small input angles exempt
  kArea,      // no triangle is larger than the size field, or its region, allows
  kLengths,   // no listed edge is longer than the size at its marker
  kKept,      // no vertex is inside a segment that is kept, unless the domain has it
  kPeriodic,  // sides that repeat each other have the same vertices and edges
  kLayers,    // layers along walls are columns of rows of the heights that were asked for
  kSimplified,  // a simplified domain is nowhere farther from the original than was asked for
};
inline constexpr std::size_t kRules = 20;

std::string_view rule_name(Rule rule);  // "coverage"

struct Violation {
  Rule rule = Rule::kDomain;
  std::string sentence;
};

// A triangle, and the middle of its corners.
struct Place {
  std::uint32_t triangle = 0;
  Vec2 at;
};

// The measures of a mesh. Angles and area are valid if no triangle is degenerate.
struct Facts {
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
  std::uint64_t edges = 0;  // listed
  double min_angle_deg = 0;
  double max_angle_deg = 0;
  double area = 0;
  // Of a simplified domain, less that of the original; nullopt if it was not judged.
  std::optional<double> area_change;
  double mean_quality = 0;      // of 4 sqrt(3) area / (sum of the squared edges)
  double min_angle_p1_deg = 0;  // 1 % of the triangles have a smaller smallest angle
  // The number of triangles with a bound on their area, over the sum of their areas over their
  // bounds: how many times the least number there are. nullopt if no triangle has a bound.
  std::optional<double> ideal_ratio;
  std::optional<double> worst_area_ratio;  // of area to its bound; nullopt if there is no bound
  std::optional<Place> worst_area_at;      // the first triangle with this ratio
  // The smallest angle that no small input angle exempts, and the first triangle with it; nullopt
  // if no angle was judged.
  std::optional<double> judged_angle_deg;
  std::optional<Place> judged_angle_at;
  // Triangles below the angle bound that a small input angle exempts: those with the corner
  // itself, and those whose shortest edge joins its two segments at equal distance from it.
  std::uint64_t exempt_corner = 0;
  std::uint64_t exempt_shell = 0;
  // Triangles that miss the angle or area bound without exemption, allowed or not; the
  // first of them, and the middle of its corners.
  std::uint64_t unrefined = 0;
  std::optional<std::uint32_t> first_unrefined;
  Vec2 first_unrefined_at;
};

struct Report {
  std::vector<Violation> violations;           // the first few of each rule, in rule order
  std::array<std::uint64_t, kRules> totals{};  // of all violations, by rule
  std::vector<Rule> not_judged;                // because of what the violations say
  Facts facts;

  bool ok() const { return violations.empty(); }
  std::uint64_t total(Rule rule) const { return totals[static_cast<std::size_t>(rule)]; }
};

// The facts, then one line per violation ("coverage: ..."), then the rules that were not judged.
// Ends with a line feed.
std::string to_text(const Report& report);

// Collects violations: counts all, and writes out the first `listed` of each rule.
class Findings {
 public:
  explicit Findings(std::uint64_t listed) : listed_(listed) {}

  // `sentence` is called only for those that are written out.
  template <class Sentence>
  void add(Rule rule, Sentence&& sentence) {
    if (totals_[static_cast<std::size_t>(rule)]++ < listed_)
      violations_.push_back({rule, sentence()});
  }
  std::uint64_t total(Rule rule) const { return totals_[static_cast<std::size_t>(rule)]; }
  bool any() const {
    return std::any_of(totals_.begin(), totals_.end(), [](std::uint64_t n) { return n > 0; });
  }
  // Adds what the other found, within the same limits.
  void merge(const Findings& other);
  void write_to(Report& report) const;
  // The same, for a report that has others' findings already.
  void add_to(Report& report) const;

 private:
  std::uint64_t listed_;
  std::array<std::uint64_t, kRules> totals_{};
  std::vector<Violation> violations_;
};

}  // namespace weft::check

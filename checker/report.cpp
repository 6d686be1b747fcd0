// SPDX-License-Identifier: Apache-2.0
#include "checker/report.h"

#include <algorithm>
#include <array>

#include "checker/text.h"

namespace weft::check {
namespace {

constexpr auto kRuleNames = std::to_array<std::string_view>(
    {"domain", "size",    "structure", "orientation", "conformity", "overlap",   "edges",
     "chains", "points",  "markers",   "coverage",    "regions",    "delaunay",  "angle",
     "area",   "lengths", "kept",      "periodic",    "layers",     "simplified"});
static_assert(kRuleNames.size() == kRules);

std::size_t index(Rule rule) {
  return static_cast<std::size_t>(rule);
}

}  // namespace

std::string_view rule_name(Rule rule) {
  return kRuleNames[index(rule)];
}

void Findings::merge(const Findings& other) {
  std::array<std::uint64_t, kRules> room{};
  for (std::size_t r = 0; r < kRules; ++r) room[r] = listed_ - std::min(listed_, totals_[r]);
  for (const Violation& violation : other.violations_) {
    if (room[index(violation.rule)] == 0) continue;
    --room[index(violation.rule)];
    violations_.push_back(violation);
  }
  for (std::size_t r = 0; r < kRules; ++r) totals_[r] += other.totals_[r];
}

void Findings::write_to(Report& report) const {
  report.violations = violations_;
  std::stable_sort(report.violations.begin(), report.violations.end(),
                   [](const Violation& a, const Violation& b) { return a.rule < b.rule; });
  report.totals = totals_;
}

void Findings::add_to(Report& report) const {
  report.violations.insert(report.violations.end(), violations_.begin(), violations_.end());
  std::stable_sort(report.violations.begin(), report.violations.end(),
                   [](const Violation& a, const Violation& b) { return a.rule < b.rule; });
  for (std::size_t r = 0; r < kRules; ++r) report.totals[r] += totals_[r];
}

std::string to_text(const Report& report) {
  const Facts& facts = report.facts;
  std::string out = say("triangles ", facts.triangles, ", vertices ", facts.vertices,
                        ", edges on segments ", facts.edges, "\nangles ", facts.min_angle_deg,
                        " to ", facts.max_angle_deg, " degrees, area ", facts.area, "\n");
  if (facts.worst_area_ratio)
    out += say("largest area over its bound ", *facts.worst_area_ratio, "\n");
  out += say("exempt because of small input angles ", facts.exempt_corner + facts.exempt_shell,
             " (", facts.exempt_corner, " with the corner, ", facts.exempt_shell,
             " on its shells), unrefined ", facts.unrefined);
  if (facts.first_unrefined)
    out += say(", the first at ", facts.first_unrefined_at, ": triangle ", *facts.first_unrefined);
  out += "\n";
  for (std::size_t i = 0; i < report.violations.size(); ++i) {
    const Violation& violation = report.violations[i];
    out += say(rule_name(violation.rule), ": ", violation.sentence, "\n");
    const bool last_of_rule =
        i + 1 == report.violations.size() || report.violations[i + 1].rule != violation.rule;
    if (!last_of_rule) continue;
    const auto listed = static_cast<std::uint64_t>(
        std::count_if(report.violations.begin(), report.violations.end(),
                      [&](const Violation& v) { return v.rule == violation.rule; }));
    if (const std::uint64_t total = report.total(violation.rule); total > listed)
      out += say(rule_name(violation.rule), ": and ", total - listed, " more\n");
  }
  if (!report.not_judged.empty()) {
    out += "not judged:";
    for (const Rule rule : report.not_judged) out += say(" ", rule_name(rule));
    out += "\n";
  }
  return out;
}

}  // namespace weft::check

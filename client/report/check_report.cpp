// SPDX-License-Identifier: Apache-2.0
#include "client/report/check_report.h"

#include <algorithm>
#include <array>

#include "client/base/files.h"
#include "client/report/mesh_figures.h"
#include "files/base/text.h"

namespace weft::client {
namespace {

using check::Rule;

// What is true if a rule holds. Angles and areas have figures instead.
constexpr auto kProperties =
    std::to_array<const char*>({"the domain is well formed",
                                "the size is positive and finite at every centroid",
                                "corners, regions and coordinates are valid",
                                "triangles are counter-clockwise",
                                "an edge has at most two triangles, one on each side",
                                "triangles do not overlap",
                                "the edges listed are those on segments",
                                "segments are chains of edges",
                                "points of the domain are vertices",
                                "edges carry the markers of their segments",
                                "the triangles cover the domain and nothing else",
                                "triangles carry the regions that they lie in",
                                "the triangulation is Delaunay, but for the edges on segments",
                                "",
                                "",
                                "edges are at most as long as the sizes at their markers",
                                "segments that are kept have no new vertices",
                                "sides that repeat each other have the same vertices",
                                "layers are columns of rows of the heights that were asked for",
                                "the domain is simplified no farther than asked"});
static_assert(kProperties.size() == check::kRules);

// `value` with 4 digits, or as many more as tell it from `bound`, if it is not the bound.
std::string rounded_beside(double value, double bound) {
  constexpr int kEnough = 4;
  constexpr int kAll = 17;
  int count = kEnough;
  while (count < kAll && value != bound && digits(value, count) == digits(bound, count)) ++count;
  return digits(value, count);
}

std::string place_text(const check::Place& place) {
  return "triangle " + with_separators(place.triangle) + " at (" + digits(place.at.x, 6) + ", " +
         digits(place.at.y, 6) + ")";
}

bool is_judged(const check::Report& report, Rule rule) {
  return std::find(report.not_judged.begin(), report.not_judged.end(), rule) ==
         report.not_judged.end();
}

// Whether the rule has anything to judge, given what was asked.
bool is_asked(Rule rule, const check::Report& report, const check::Requirements& requirements) {
  switch (rule) {
    case Rule::kSize:
      return !std::holds_alternative<std::monostate>(requirements.size.value) ||
             !requirements.size.at.empty();
    case Rule::kAngle:
      return !is_judged(report, rule) || report.facts.judged_angle_deg.has_value();
    case Rule::kArea:
      return !is_judged(report, rule) || report.facts.worst_area_ratio.has_value();
    case Rule::kLengths:  // it is not judged if triangles may miss their bounds
      return !requirements.size.at.empty() && requirements.allowed_unrefined == 0;
    case Rule::kKept:
      return requirements.keep.has_value();
    case Rule::kPeriodic:
      return !requirements.periodic.empty();
    case Rule::kLayers:
      return !requirements.layers.empty();
    case Rule::kSimplified:
      return requirements.simplify > 0;
    default:
      return true;
  }
}

bool misses_angle(const check::Facts& facts, const check::Requirements& requirements) {
  return facts.judged_angle_deg &&
         *facts.judged_angle_deg < requirements.min_angle_deg.value_or(0) - check::kAngleTolerance;
}
bool misses_area(const check::Facts& facts) {
  return facts.worst_area_ratio && *facts.worst_area_ratio > 1 + check::kAreaTolerance;
}

std::string angle_sentence(const check::Facts& facts, const check::Requirements& requirements) {
  const double bound = requirements.min_angle_deg.value_or(0);
  const double least = *facts.judged_angle_deg;
  return "angles at least " +
         (misses_angle(facts, requirements) ? rounded_beside(least, bound) : digits(least, 4)) +
         " degrees, " + shortest(bound) + " required";
}

std::string area_sentence(const check::Facts& facts) {
  const double ratio = *facts.worst_area_ratio;
  return "area at most " + (misses_area(facts) ? rounded_beside(ratio, 1) : digits(ratio, 4)) +
         " of its bound";
}

std::string sentence(Rule rule, const check::Report& report,
                     const check::Requirements& requirements) {
  if (rule == Rule::kAngle) return angle_sentence(report.facts, requirements);
  if (rule == Rule::kArea) return area_sentence(report.facts);
  return kProperties[static_cast<std::size_t>(rule)];
}

// The worst triangle, of a rule that has one.
std::string worst_text(Rule rule, const check::Facts& facts) {
  const auto& place = rule == Rule::kAngle ? facts.judged_angle_at : facts.worst_area_at;
  if ((rule != Rule::kAngle && rule != Rule::kArea) || !place) return "";
  return "; the worst is " + place_text(*place);
}

// Whether a triangle misses the bound that the rule is about.
bool misses(Rule rule, const check::Facts& facts, const check::Requirements& requirements) {
  return (rule == Rule::kArea && misses_area(facts)) ||
         (rule == Rule::kAngle && misses_angle(facts, requirements));
}

std::string verdict(Rule rule, const check::Report& report,
                    const check::Requirements& requirements) {
  const std::uint64_t total = report.total(rule);
  if (total == 0)
    return misses(rule, report.facts, requirements) ? ": missed, as allowed\n" : ": holds\n";
  std::string text = ": fails, " + with_separators(total) + (total == 1 ? " time" : " times") +
                     worst_text(rule, report.facts) + "\n";
  std::uint64_t listed = 0;
  for (const check::Violation& violation : report.violations) {
    if (violation.rule != rule) continue;
    text += "  " + violation.sentence + "\n";
    ++listed;
  }
  if (total > listed) text += "  and " + with_separators(total - listed) + " more\n";
  return text;
}

std::string triangles_text(std::uint64_t count) {
  return with_separators(count) + (count == 1 ? " triangle" : " triangles");
}

// A line about triangles that miss a bound but are exempt from it.
std::string exempt_text(const check::Facts& facts, const check::Requirements& requirements) {
  std::string text;
  if (const std::uint64_t exempt = facts.exempt_corner + facts.exempt_shell; exempt > 0)
    text = triangles_text(exempt) + " with smaller angles, because of small input angles\n";
  if (facts.unrefined > 0 && facts.unrefined <= requirements.allowed_unrefined)
    text += triangles_text(facts.unrefined) +
            (facts.unrefined == 1 ? " misses a bound; at most " : " miss a bound; at most ") +
            with_separators(requirements.allowed_unrefined) + " may. The first is " +
            place_text({*facts.first_unrefined, facts.first_unrefined_at}) + "\n";
  return text;
}

Json place_json(const check::Place& place) {
  return {{"triangle", place.triangle}, {"at", {place.at.x, place.at.y}}};
}

}  // namespace

std::string check_text(const check::Report& report, const check::Requirements& requirements) {
  const check::Facts& facts = report.facts;
  std::string text = triangles_text(facts.triangles) + ", " + with_separators(facts.vertices) +
                     " vertices, " + with_separators(facts.edges) + " edges on segments, area " +
                     digits(facts.area, 6) + "\n";
  std::string not_judged;
  for (std::size_t r = 0; r < check::kRules; ++r) {
    const auto rule = static_cast<Rule>(r);
    if (report.total(rule) == 0 && !is_asked(rule, report, requirements)) continue;
    if (!is_judged(report, rule))
      not_judged += (not_judged.empty() ? "" : ", ") + std::string(check::rule_name(rule));
    else
      text += sentence(rule, report, requirements) + verdict(rule, report, requirements);
  }
  text += exempt_text(facts, requirements);
  if (!not_judged.empty()) text += "not judged, because other rules fail: " + not_judged + "\n";
  return text + (report.ok() ? "the mesh holds\n" : "the mesh fails\n");
}

Json check_json(const check::Report& report, const check::Requirements& requirements) {
  const check::Facts& facts = report.facts;
  Json json = {{"holds", report.ok()}};
  json.update(figures_json({.vertices = facts.vertices,
                            .triangles = facts.triangles,
                            .edges = facts.edges,
                            .area = facts.area,
                            .min_angle_deg = facts.min_angle_deg,
                            .max_angle_deg = facts.max_angle_deg,
                            .min_angle_p1_deg = facts.min_angle_p1_deg,
                            .mean_quality = facts.mean_quality,
                            .ideal_ratio = facts.ideal_ratio.value_or(0)}));
  if (facts.judged_angle_deg) {
    json["angle"] = place_json(*facts.judged_angle_at);
    json["angle"]["deg"] = *facts.judged_angle_deg;
    json["angle"]["bound_deg"] = requirements.min_angle_deg.value_or(0);
  }
  if (facts.worst_area_ratio) {
    json["area_over_bound"] = place_json(*facts.worst_area_at);
    json["area_over_bound"]["ratio"] = *facts.worst_area_ratio;
  }
  json["excused"] = {{"corner", facts.exempt_corner}, {"shell", facts.exempt_shell}};
  json["unrefined"] = facts.unrefined;
  Json rules = Json::object();
  for (std::size_t r = 0; r < check::kRules; ++r) {
    const auto rule = static_cast<Rule>(r);
    rules[std::string(check::rule_name(rule))] = {{"judged", is_judged(report, rule)},
                                                  {"violations", report.total(rule)}};
  }
  json["rules"] = std::move(rules);
  json["violations"] = Json::array();
  for (const check::Violation& violation : report.violations)
    json["violations"].push_back({{"rule", std::string(check::rule_name(violation.rule))},
                                  {"sentence", violation.sentence}});
  return json;
}

}  // namespace weft::client

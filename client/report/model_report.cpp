// SPDX-License-Identifier: Apache-2.0
#include "client/report/model_report.h"

#include <algorithm>
#include <array>

#include "client/base/files.h"
#include "files/base/text.h"

namespace weft::client {
namespace {

using check::Grade;
using check::ModelRule;

struct ModelNames {
  const char* flag;
  const char* name;
};
constexpr std::array<ModelNames, 4> kModels = {{{"adcirc", "ADCIRC"},
                                                {"schism", "SCHISM"},
                                                {"telemac", "TELEMAC-2D"},
                                                {"delft3d", "Delft3D-FM"}}};

std::string four_digits(double value) {
  return digits(value, 4);
}
std::string place_text(check::Vec2 p) {
  return "(" + digits(p.x, 9) + ", " + digits(p.y, 9) + ")";
}

bool is_about_open(ModelRule rule) {
  return rule == ModelRule::kOpenRing || rule == ModelRule::kOpenIsland ||
         rule == ModelRule::kShortOpen;
}

// What is true if the rule holds.
std::string property(ModelRule rule, const check::ModelReport& report) {
  switch (rule) {
    case ModelRule::kConformity:
      return "an edge has at most two triangles, one on each side";
    case ModelRule::kIdleVertex:
      return "every vertex has a triangle";
    case ModelRule::kPinchedVertex:
      return "the boundary passes each vertex once";
    case ModelRule::kOnePart:
      return "all triangles are connected across edges";
    case ModelRule::kOpenRing:
      return "no open boundary is a whole ring";
    case ModelRule::kOpenIsland:
      return "no open boundary is on an island";
    case ModelRule::kShortOpen:
      return "open boundaries have two edges at least";
    case ModelRule::kValence:
      return "a vertex has at most " + std::to_string(check::kMaxValence) +
             " triangles; the most is " + std::to_string(report.max_valence);
    case ModelRule::kChannel:
      return "no channel is one triangle wide";
    case ModelRule::kDeadCorner:
      return "no triangle has two edges on land";
    case ModelRule::kOrthogonality:
      return "the cosine between links of cells and their edges is at most " +
             four_digits(check::kMaxCosine) + "; the largest is " + four_digits(report.max_cosine);
    case ModelRule::kShortLink:
      return "links of cells are at least " + four_digits(check::kMinLink) +
             " of the root of their cells' areas";
  }
  return "";
}

std::string measure_text(const check::ModelFinding& finding) {
  switch (finding.rule) {
    case ModelRule::kOnePart:
      return ", a part of " + with_separators(static_cast<std::uint64_t>(finding.measure)) +
             (finding.measure == 1 ? " triangle" : " triangles");
    case ModelRule::kValence:
      return ", " + four_digits(finding.measure) + " triangles";
    case ModelRule::kOrthogonality:
    case ModelRule::kShortLink:
      return ", " + four_digits(finding.measure);
    default:
      return "";
  }
}

std::string rule_text(const ModelView& view, ModelRule rule) {
  const std::uint64_t total = view.report.total(rule);
  std::string text = property(rule, view.report);
  if (total == 0) return text + ": holds\n";
  text += check::grade(view.model, rule) == Grade::kFault ? ": fails, " : ": advice, missed ";
  text += with_separators(total) + (total == 1 ? " time\n" : " times\n");
  std::uint64_t listed = 0;
  for (const check::ModelFinding& finding : view.report.findings) {
    if (finding.rule != rule) continue;
    text += "  at " + place_text(finding.at) + measure_text(finding) + "\n";
    ++listed;
  }
  if (total > listed && listed > 0) text += "  and " + with_separators(total - listed) + " more\n";
  return text;
}

std::string figures_text(const ModelView& view) {
  const check::ModelReport& report = view.report;
  std::string text;
  if (report.shortest_edge)
    text += "the shortest edge has " + four_digits(*report.shortest_edge) + " m\n";
  if (const auto& step = report.time_step)
    text += "time step at most " + four_digits(step->seconds) +
            " s at a Courant number of 1: an edge of " + four_digits(step->length) + " m at " +
            place_text(step->at) + ", " + four_digits(step->depth) + " m deep\n";
  else if (!view.has_depths)
    text += "no time step: the mesh has no depths (--nodal depth=FILE when it is made)\n";
  return text;
}

// Calls `with` for each rule of the model.
template <class F>
void for_rules(const ModelView& view, F&& with) {
  for (std::size_t r = 0; r < check::kModelRules; ++r) {
    const auto rule = static_cast<ModelRule>(r);
    if (check::grade(view.model, rule) != Grade::kNone) with(rule);
  }
}

bool is_judged(const ModelView& view, ModelRule rule) {
  if (rule == ModelRule::kConformity) return true;
  return view.report.total(ModelRule::kConformity) == 0 && (view.has_open || !is_about_open(rule));
}

}  // namespace

std::vector<std::pair<std::string, std::optional<check::Model>>> models() {
  std::vector<std::pair<std::string, std::optional<check::Model>>> all;
  for (std::size_t m = 0; m < kModels.size(); ++m)
    all.emplace_back(kModels[m].flag, static_cast<check::Model>(m));
  return all;
}

std::string model_name(check::Model model) {
  return kModels[static_cast<std::size_t>(model)].name;
}

bool ModelView::holds() const {
  bool holds = true;
  for_rules(*this, [&](ModelRule rule) {
    holds &= check::grade(model, rule) != Grade::kFault || report.total(rule) == 0;
  });
  return holds;
}

std::string model_text(const ModelView& view) {
  std::string text;
  bool has_idle_rules = false;
  for_rules(view, [&](ModelRule rule) {
    if (is_judged(view, rule))
      text += rule_text(view, rule);
    else
      has_idle_rules |= is_about_open(rule);
  });
  if (view.report.total(ModelRule::kConformity) > 0)
    text += "nothing else is judged, because of that\n";
  else if (has_idle_rules)
    text += "open boundaries are not judged: no --open-boundary is given\n";
  return text + figures_text(view) + "the mesh " + (view.holds() ? "holds" : "fails") + " for " +
         model_name(view.model) + "\n";
}

Json model_json(const ModelView& view) {
  const check::ModelReport& report = view.report;
  Json json = {{"model", kModels[static_cast<std::size_t>(view.model)].flag},
               {"holds", view.holds()},
               {"rules", Json::object()},
               {"violations", Json::array()},
               {"parts", report.parts},
               {"max_valence", report.max_valence},
               {"max_cosine", report.max_cosine}};
  for_rules(view, [&](ModelRule rule) {
    json["rules"][std::string(check::model_rule_name(rule))] = {
        {"grade", check::grade(view.model, rule) == Grade::kFault ? "fault" : "advice"},
        {"judged", is_judged(view, rule)},
        {"violations", report.total(rule)}};
  });
  for (const check::ModelFinding& finding : report.findings) {
    if (check::grade(view.model, finding.rule) == Grade::kNone) continue;
    Json one = {{"rule", std::string(check::model_rule_name(finding.rule))},
                {"at", {finding.at.x, finding.at.y}}};
    if (!measure_text(finding).empty()) one["measure"] = finding.measure;
    json["violations"].push_back(std::move(one));
  }
  if (report.shortest_edge) json["shortest_edge"] = *report.shortest_edge;
  if (const auto& step = report.time_step)
    json["time_step"] = {{"seconds", step->seconds},
                         {"at", {step->at.x, step->at.y}},
                         {"edge", step->length},
                         {"depth", step->depth}};
  return json;
}

}  // namespace weft::client

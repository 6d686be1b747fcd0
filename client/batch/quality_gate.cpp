// SPDX-License-Identifier: Apache-2.0
#include "client/batch/quality_gate.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "files/base/text.h"

namespace weft::client {
namespace {

struct Figure {
  const char* name;
  bool lower;  // the bound is a lower one
  double (*of)(const v1::Summary&);
};

constexpr std::array<Figure, 6> kFigures = {{
    {"min-angle", true, [](const v1::Summary& s) { return s.min_angle_deg(); }},
    {"max-angle", false, [](const v1::Summary& s) { return s.max_angle_deg(); }},
    {"min-triangles", true,
     [](const v1::Summary& s) { return static_cast<double>(s.triangles()); }},
    {"max-triangles", false,
     [](const v1::Summary& s) { return static_cast<double>(s.triangles()); }},
    {"max-vertices", false, [](const v1::Summary& s) { return static_cast<double>(s.vertices()); }},
    {"max-unrefined", false,
     [](const v1::Summary& s) {
       const v1::Unrefined& u = s.unrefined();
       return static_cast<double>(u.edge_floor() + u.kept() + u.budget() + u.precision() +
                                  u.streaming());
     }},
}};

const Figure* find_figure(std::string_view name) {
  const auto* found = std::find_if(kFigures.begin(), kFigures.end(),
                                   [&](const Figure& figure) { return figure.name == name; });
  return found == kFigures.end() ? nullptr : found;
}

std::string known_figures() {
  std::string names;
  for (const Figure& figure : kFigures) {
    if (!names.empty()) names += ", ";
    names += figure.name;
  }
  return names;
}

}  // namespace

Result<QualityGate> QualityGate::parse(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos)
    return fail(ExitCode::kUsage, in_quotes(text) + " is not FIGURE=BOUND, such as min-angle=20");
  return make(text.substr(0, equals), text.substr(equals + 1));
}

Result<QualityGate> QualityGate::make(std::string_view figure, std::string_view bound) {
  if (find_figure(figure) == nullptr)
    return fail(
        ExitCode::kUsage,
        in_quotes(figure) + " is not a figure of a mesh; the figures are " + known_figures());
  double value = 0;
  const auto [end, problem] = std::from_chars(bound.data(), bound.data() + bound.size(), value);
  if (problem != std::errc() || end != bound.data() + bound.size() || !std::isfinite(value))
    return fail(ExitCode::kUsage,
                std::string(figure) + ": " + in_quotes(bound) + " is not a number");
  return QualityGate(std::string(figure), value);
}

std::optional<std::string> QualityGate::violation(const v1::Summary& summary) const {
  const Figure& figure = *find_figure(figure_);
  const double value = figure.of(summary);
  if (figure.lower ? value >= bound_ : value <= bound_) return std::nullopt;
  return figure_ + " is " + shortest(value) + (figure.lower ? ", less than " : ", more than ") +
         shortest(bound_);
}

}  // namespace weft::client

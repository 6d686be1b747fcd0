// SPDX-License-Identifier: Apache-2.0
#include "client/lint/lint_report.h"

#include <vector>

#include "files/base/text.h"

namespace weft::client {
namespace {

constexpr char kTooMany[] =
    "segments meet in more than 200,000 points, so ends, faces and seeds were not looked at";

// In 12 digits: crossings are computed.
std::string place_text(Point p) {
  return "(" + digits(p.x, 12) + ", " + digits(p.y, 12) + ")";
}

std::string count_text(const Lint& lint) {
  if (lint.total == 0) return "no faults in " + lint.file + "\n";
  std::string text =
      with_separators(lint.total) + (lint.total == 1 ? " fault in " : " faults in ") + lint.file;
  for (std::size_t k = 0; k < lint.counts.size(); ++k)
    text += (k == 0 ? ": " : ", ") + with_separators(lint.counts[k].second) + " " +
            lint.counts[k].first;
  return text + "\n";
}

Json geometry_of(const Finding& finding) {
  if (!finding.at) return nullptr;
  if (!finding.to) return {{"type", "Point"}, {"coordinates", position(*finding.at)}};
  return {{"type", "LineString"},
          {"coordinates", Json::array({position(*finding.at), position(*finding.to)})}};
}

}  // namespace

std::string lint_text(const Lint& lint) {
  constexpr std::uint64_t kMaxOfAKind = 20;
  std::string text;
  std::size_t next = 0;
  for (const auto& [kind, total] : lint.counts) {
    std::uint64_t told = 0;
    for (; next < lint.findings.size() && lint.findings[next].kind == kind; ++next) {
      const Finding& finding = lint.findings[next];
      if (told == kMaxOfAKind) continue;
      ++told;
      text += kind + (finding.at ? " at " + place_text(*finding.at) : "") + ": " + finding.text +
              (finding.remedy.empty() ? "" : "; " + finding.remedy) + "\n";
    }
    if (told < total) text += kind + ": and " + with_separators(total - told) + " more\n";
  }
  if (!lint.complete) text += std::string(kTooMany) + "\n";
  return text + count_text(lint);
}

void write_lint_layer(const Lint& lint, OutputFile& file) {
  file.put(R"({"type":"FeatureCollection","features":[)");
  for (std::size_t i = 0; i < lint.findings.size(); ++i) {
    const Json feature = {{"type", "Feature"},
                          {"properties", properties_of(lint.findings[i])},
                          {"geometry", geometry_of(lint.findings[i])}};
    file.put(i == 0 ? "\n" : ",\n");
    std::string line = json_line(feature);
    line.pop_back();
    file.put(line);
  }
  file.put("\n]}\n");
}

void draw_lint(const Domain& domain, const Lint& lint, Drawing& drawing) {
  std::vector<double> coordinates;
  coordinates.reserve(2 * domain.points.size());
  for (const Point& p : domain.points) coordinates.insert(coordinates.end(), {p.x, p.y});
  std::vector<std::uint32_t> edges;
  std::vector<std::int32_t> markers;
  for (const Domain::Segment& segment : domain.segments) {
    edges.insert(edges.end(), {segment.a, segment.b});
    markers.push_back(segment.marker);
  }
  MeshView view;
  view.coordinates = coordinates;
  view.edges = edges;
  view.edge_markers = markers;
  drawing.add(view);
  std::size_t next = 0;
  for (const auto& [kind, total] : lint.counts) {
    DrawnMarks marks{kind + (total == 1 ? "" : " (" + with_separators(total) + ")"), {}};
    for (; next < lint.findings.size() && lint.findings[next].kind == kind; ++next) {
      const Finding& finding = lint.findings[next];
      if (!finding.at) continue;
      const Point to = finding.to.value_or(*finding.at);
      marks.at.push_back(
          {finding.at->x + (to.x - finding.at->x) / 2, finding.at->y + (to.y - finding.at->y) / 2});
    }
    if (!marks.at.empty()) drawing.mark(std::move(marks));
  }
}

}  // namespace weft::client

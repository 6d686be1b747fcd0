// SPDX-License-Identifier: Apache-2.0
#include "files/lint/domain_lint.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "checker/domain/domain_rules.h"
#include "checker/lint/lint.h"
#include "files/base/text.h"
#include "files/formats/domain_formats.h"
#include "files/formats/domains/to_checker.h"
#include "files/formats/mesh_formats.h"
#include "files/geo/projection_options.h"
#include "files/lint/judged_domain.h"

namespace weft::files {
namespace {

using check::Fault;
using check::FaultKind;
using check::Offender;

constexpr char kWarning[] = "warning";

std::string rounded(double value) {
  return digits(value, 3);
}

class Wording {
 public:
  Wording(const JudgedDomain& judged, const std::string& file, bool lonlat)
      : judged_(judged), domain_(judged.domain()), file_(file), lonlat_(lonlat) {}

  Finding finding(const Fault& fault) const {
    Finding out{.kind = std::string(fault_name(fault.kind)),
                .at = judged_.in_file({fault.at.x, fault.at.y}),
                .text = text(fault),
                .remedy = remedy(fault)};
    if (fault.to) out.to = judged_.in_file({fault.to->x, fault.to->y});
    for (const Offender& offender : fault.offenders) out.offenders.push_back(place(offender));
    if (fault.measure > 0) out.measure = fault.measure;
    return out;
  }

 private:
  // "line 7" or "features[0].geometry.coordinates[0][3]"; with its name if it is another file.
  std::string place(const Offender& offender) const {
    const auto [what, i] = offender;
    std::string where = what == Offender::What::kPoint     ? domain_.point_places.locate(i)
                        : what == Offender::What::kSegment ? domain_.segment_places.locate(i)
                        : what == Offender::What::kHole    ? domain_.hole_places.locate(i)
                        : what == Offender::What::kRegion  ? domain_.region_places.locate(i)
                                                           : domain_.area_places.locate(i);
    if (where.empty()) return "number " + std::to_string(i);
    // A polygon is the only area of its geometry.
    if (const auto end = where.rfind(", area "); what == Offender::What::kArea && end != where.npos)
      where.erase(end);
    if (where.starts_with(file_ + ": ")) return where.substr(file_.size() + 2);
    if (where.starts_with(file_ + ":")) return "line " + where.substr(file_.size() + 1);
    return where;
  }

  std::string name(const Fault& fault, std::size_t k) const {
    constexpr const char* kNouns[] = {"the point at ", "the segment at ", "the hole seed at ",
                                      "the region seed at ", "the polygon at "};
    const Offender& offender = fault.offenders[k];
    return kNouns[static_cast<std::size_t>(offender.what)] + place(offender);
  }

  // "A and B", of all offenders.
  std::string names(const Fault& fault) const {
    std::string all;
    for (std::size_t k = 0; k < fault.offenders.size(); ++k)
      all += (k == 0 ? "" : " and ") + name(fault, k);
    return all;
  }

  std::string text(const Fault& fault) const {
    const std::string measure = rounded(fault.measure);
    const std::string length = measure + (lonlat_ ? " m" : "");
    const std::string area = measure + (lonlat_ ? " square metres" : "");
    switch (fault.kind) {
      case FaultKind::kOpenEnd:
        return "no other segment touches this end of " + name(fault, 0);
      case FaultKind::kGap:
        return "a gap of " + length + " between the end of " + name(fault, 0) + " and " +
               (fault.to ? "that of " : "") + name(fault, 1);
      case FaultKind::kCrossing:
        return name(fault, 0) + " crosses " + name(fault, 1);
      case FaultKind::kSelfCrossing:
        return "a ring crosses itself: " + name(fault, 0) + " crosses " + name(fault, 1);
      case FaultKind::kJunction:
        return name(fault, 0) + " lies on the inside of " + name(fault, 1);
      case FaultKind::kOverlap:
        return names(fault) + " coincide on a length of " + length;
      case FaultKind::kAreaOverlap:
        return names(fault) + " overlap on an area of " + area;
      case FaultKind::kNearPoints:
        return names(fault) + " are " + length + " apart";
      case FaultKind::kNearSegment:
        return name(fault, 0) + " is " + length + " off " + name(fault, 1);
      case FaultKind::kSmallAngle:
        return names(fault) + " meet at " + measure + " degrees";
      case FaultKind::kSliver:
        return "a face is " + length + " wide, beside " + names(fault);
      case FaultKind::kDuplicatePoint:
        return name(fault, 0) + " is where " + name(fault, 1) + " is";
      case FaultKind::kDuplicateSegment:
        return name(fault, 0) + " has the ends of " + name(fault, 1);
      case FaultKind::kZeroLength:
        return name(fault, 0) + " has length 0";
      case FaultKind::kSeedOutside:
        return name(fault, 0) + " is in no face that segments enclose";
      case FaultKind::kSeedOnSegment:
        return name(fault, 0) + " is on " +
               (fault.offenders.size() > 1 ? name(fault, 1) : "a segment");
      case FaultKind::kSeedShared:
        return name(fault, 0) + " is in the face of " + name(fault, 1) + ", which counts";
    }
    return "";
  }

  std::string remedy(const Fault& fault) const {
    switch (fault.kind) {
      case FaultKind::kOpenEnd:
        return "join it to another segment, or leave the segment out";
      case FaultKind::kGap:
        return snap(
            fault,
            0.5 * std::min(length(fault.offenders[0].index), length(fault.offenders[1].index)),
            "join them");
      case FaultKind::kNearPoints:
      case FaultKind::kNearSegment:
        return snap(fault, fault.measure * 1e3, "");
      case FaultKind::kCrossing:
      case FaultKind::kJunction:
        return "weft makes a vertex there; move one if it is not meant";
      case FaultKind::kSelfCrossing:
        return "parity decides what is inside; draw the ring anew if that is not meant";
      case FaultKind::kOverlap:
        return "end one where the other begins";
      case FaultKind::kAreaOverlap:
        return "move their borders, or choose by --fill";
      case FaultKind::kSmallAngle:
        return "triangles there have such an angle, too";
      case FaultKind::kSliver:
        return "triangles there are as small; move a border onto the other";
      case FaultKind::kDuplicatePoint:
      case FaultKind::kDuplicateSegment:
      case FaultKind::kZeroLength:
        return "leave it out";
      case FaultKind::kSeedOutside:
      case FaultKind::kSeedOnSegment:
      case FaultKind::kSeedShared:
        return "move the seed into its face, or leave it out";
    }
    return "";
  }

  double length(std::uint32_t segment) const {
    const auto& [a, b, marker, area] = domain_.segments[segment];
    return std::hypot(domain_.points[b].x - domain_.points[a].x,
                      domain_.points[b].y - domain_.points[a].y);
  }

  // A merging distance in two digits, above the fault's; `otherwise` if it is not below `most`,
  // because it would merge what is meant to be there.
  std::string snap(const Fault& fault, double most, const std::string& otherwise) const {
    constexpr double kMargin = 1.05;
    if (!(kMargin * fault.measure < most)) return otherwise;
    const double least = kMargin * fault.measure * judged_.greatest_length();
    return "--snap " + two_digits_above(least) +
           (fault.kind == FaultKind::kGap ? " closes it" : " merges them");
  }

  const JudgedDomain& judged_;
  const Domain& domain_;
  const std::string& file_;
  bool lonlat_;
};

void count(Lint& lint, const std::string& kind, std::uint64_t total) {
  if (total == 0) return;
  lint.counts.emplace_back(kind, total);
  lint.total += total;
}

}  // namespace

std::string fault_kinds() {
  std::string all;
  for (std::size_t kind = 0; kind < check::kFaultKinds; ++kind)
    all += (kind == 0 ? "" : ", ") + std::string(fault_name(static_cast<FaultKind>(kind)));
  return all;
}

bool is_fault_kind(const std::string& name) {
  for (std::size_t kind = 0; kind < check::kFaultKinds; ++kind)
    if (fault_name(static_cast<FaultKind>(kind)) == name) return true;
  return name == kWarning;
}

Result<Lint> lint_domain(const Domain& domain, const DataPath& path, const LintSettings& settings) {
  const std::string file = path.string();
  const bool of_mesh = !is_plain_domain_path(path);
  const auto prepared = JudgedDomain::make(domain, settings.lonlat, of_mesh);
  if (!prepared) {
    const auto& [exit, message] = prepared.error();
    return fail(exit, message.starts_with(file) ? message : file + ": " + message);
  }
  const double snap = settings.lonlat && settings.snap == 0 ? kProjectedSnap : settings.snap;
  const check::Domain judged = checker_domain(prepared->domain(), snap);
  check::Findings malformed(1);
  if (!check::judge_domain(judged, malformed)) {
    check::Report report;
    malformed.write_to(report);
    return fail(ExitCode::kUnreadableInput, file + ": " + report.violations.front().sentence);
  }
  // In .poly files alone, segments refer to points by their numbers.
  const check::LintResult found = check::lint(judged, lower_extension(path) == ".poly");
  const auto is_ignored = [&](const std::string& kind) {
    return std::find(settings.ignored.begin(), settings.ignored.end(), kind) !=
           settings.ignored.end();
  };
  Lint lint{.file = file, .complete = found.complete};
  const Wording wording(*prepared, file, settings.lonlat);
  for (const Fault& fault : found.faults.kept())
    if (!is_ignored(std::string(fault_name(fault.kind))))
      lint.findings.push_back(wording.finding(fault));
  for (std::size_t kind = 0; kind < check::kFaultKinds; ++kind) {
    const std::string name(fault_name(static_cast<FaultKind>(kind)));
    if (!is_ignored(name)) count(lint, name, found.faults.total(static_cast<FaultKind>(kind)));
  }
  if (is_ignored(kWarning)) return lint;
  std::uint64_t warnings = 0;
  for (const Warning& warning : domain.warnings) {
    if (is_of_crossing(warning.kind)) continue;  // a fault of its own
    ++warnings;
    const bool is_of_all = warning.file == file && warning.line == 0;
    lint.findings.push_back({.kind = kWarning,
                             .warning = std::string(warning_name(warning.kind)),
                             .text = is_of_all ? warning.text : warning.sentence()});
  }
  count(lint, kWarning, warnings);
  return lint;
}

void add_warning(Lint& lint, std::string text) {
  lint.findings.push_back({.kind = kWarning,
                           .warning = std::string(warning_name(WarningKind::kCoordinates)),
                           .text = std::move(text)});
  if (lint.counts.empty() || lint.counts.back().first != kWarning)
    lint.counts.emplace_back(kWarning, 0);
  ++lint.counts.back().second;
  ++lint.total;
}

}  // namespace weft::files

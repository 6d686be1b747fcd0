// SPDX-License-Identifier: Apache-2.0
#include "files/formats/warning.h"

namespace weft::files {

std::string Warning::sentence() const {
  if (file.empty()) return text;
  return file + (line > 0 ? ":" + std::to_string(line) : "") + ": " + text;
}

std::string_view warning_name(WarningKind kind) {
  switch (kind) {
    case WarningKind::kRingCrossesItself:
      return "ring-crosses-itself";
    case WarningKind::kRingCrossesAnother:
      return "ring-crosses-another";
    case WarningKind::kRingsOverlap:
      return "rings-overlap";
    case WarningKind::kOpenRing:
      return "open-ring";
    case WarningKind::kRepeatedRing:
      return "repeated-ring";
    case WarningKind::kNestedOutline:
      return "nested-outline";
    case WarningKind::kLeftOut:
      return "left-out";
    case WarningKind::kProperty:
      return "property";
    case WarningKind::kName:
      return "name";
    case WarningKind::kGroup:
      return "group";
    case WarningKind::kColumn:
      return "column";
    case WarningKind::kRow:
      return "row";
    case WarningKind::kCoordinates:
      return "coordinates";
    case WarningKind::kOverlappingTriangles:
      return "overlapping-triangles";
    case WarningKind::kRepeatedTriangle:
      return "repeated-triangle";
    case WarningKind::kCutFaces:
      return "cut-faces";
    case WarningKind::kNotWritten:
      return "not-written";
    case WarningKind::kOpenBoundary:
      return "open-boundary";
  }
  return "";
}

bool is_of_crossing(WarningKind kind) {
  return kind == WarningKind::kRingCrossesItself || kind == WarningKind::kRingCrossesAnother;
}

std::vector<std::string> sentences(const std::vector<Warning>& warnings) {
  std::vector<std::string> all;
  for (const Warning& warning : warnings) all.push_back(warning.sentence());
  return all;
}

}  // namespace weft::files

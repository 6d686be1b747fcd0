// SPDX-License-Identifier: Apache-2.0
// What a reader has to say of a file that it could read: as data for programs, and as a sentence
// for people. Programs go by the kind, never by the words.
//
//   domain.warnings.push_back({.kind = WarningKind::kName, .file = "a.poly", .text = "..."});
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace weft::files {

enum class WarningKind {
  kRingCrossesItself,   // parity decides what is inside
  kRingCrossesAnother,  // of its polygon
  kRingsOverlap,        // of a polygon, without crossing
  kOpenRing,            // a segment closes it
  kRepeatedRing,        // a ring that ended comes again
  kNestedOutline,       // of a drawing, filled
  kLeftOut,             // geometries of which nothing can be meshed, or that are not read
  kProperty,            // left out, or without effect
  kName,                // of a marker or a region, left out
  kGroup,               // of elements of a mesh, lost
  kColumn,              // of a table, ignored
  kRow,                 // of a table, taken for something else
  kCoordinates,         // their system is not what is expected
  kOverlappingTriangles,
  kRepeatedTriangle,
  kCutFaces,      // of more than three corners, into triangles
  kNotWritten,    // values, parts or names that a format does not carry
  kOpenBoundary,  // asked for, but not in the mesh
};

struct Warning {
  WarningKind kind{};
  std::string file{};       // its path; empty: it was read from memory
  std::uint64_t line = 0;   // of the file, from 1; 0: not of a line
  std::string place{};      // of the first of them: "features[3].geometry"; may be empty
  std::uint64_t count = 1;  // so many of the kind
  std::string text{};       // a sentence without a full stop, that names the place

  // "a.csv:7: text", on one line.
  std::string sentence() const;
  friend bool operator==(const Warning&, const Warning&) = default;
};

// "ring-crosses-itself": for JSON.
std::string_view warning_name(WarningKind kind);

// Whether it says that rings cross, as a fault of its own does in `weft lint`.
bool is_of_crossing(WarningKind kind);

std::vector<std::string> sentences(const std::vector<Warning>& warnings);

}  // namespace weft::files

// SPDX-License-Identifier: Apache-2.0
// What shallow-water models ask of a mesh, beyond bounds on angles and areas: faults, which they
// refuse or which stop the flow, and advice. Judged from the mesh alone, not from its domain.
//
//   ADCIRC, SCHISM  boundaries that can be walked: no pinched vertex, open boundaries of two edges
//                   at least, none that is a whole ring, none around an island; one part
//   TELEMAC-2D      the same of open (liquid) boundaries of two points at least; triangles with
//                   three vertices on the boundary ("overstressed") carry no flow
//   Delft3D-FM      cells whose centres are connected by lines (links) normal to their common edge:
//                   cosine of the angle between link and edge at most 0.5, links not short
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "checker/mesh.h"

namespace weft::check {

enum class Model : std::uint8_t { kAdcirc, kSchism, kTelemac, kDelft3d };

enum class ModelRule : std::uint8_t {
  kConformity,     // an edge has at most two triangles, one on each side; others build on it
  kIdleVertex,     // a vertex has a triangle
  kPinchedVertex,  // the boundary passes a vertex once
  kOnePart,        // all triangles are connected across edges; measure: the triangles of a part
  kOpenRing,       // an open boundary is not a whole ring
  kOpenIsland,     // an open boundary is not on the ring of an island
  kShortOpen,      // an open boundary has two edges at least
  kValence,        // a vertex has at most kMaxValence triangles; measure: their number
  kChannel,        // no edge crosses the domain from boundary to boundary, but beside a dead corner
  kDeadCorner,     // no triangle has two edges on land
  kOrthogonality,  // measure: the cosine of the angle between link and edge
  kShortLink,      // measure: length of the link over that which the areas of its cells suggest
};
inline constexpr std::size_t kModelRules = 12;

inline constexpr std::uint32_t kMaxValence = 8;
inline constexpr double kMaxCosine = 0.5;
inline constexpr double kMinLink = 0.1;

enum class Grade : std::uint8_t { kNone, kAdvice, kFault };
Grade grade(Model model, ModelRule rule);

std::string_view model_rule_name(ModelRule rule);  // "pinched-vertex"

struct ModelFinding {
  ModelRule rule = ModelRule::kIdleVertex;
  Vec2 at;
  double measure = 0;
};

// A time step is what a wave of length much above the depth, of speed sqrt(g depth), takes along
// the shortest edge of its vertices; a Courant number of 1.
struct TimeStep {
  double seconds = 0;
  Vec2 at;  // the middle of the edge
  double length = 0;
  double depth = 0;
};

struct ModelReport {
  std::array<std::uint64_t, kModelRules> totals{};
  std::vector<ModelFinding> findings;  // by rule, the first kListed of each, in the mesh's order
  std::uint32_t parts = 0;
  std::uint32_t max_valence = 0;
  double max_cosine = 0;
  std::optional<double> shortest_edge;  // metres
  std::optional<TimeStep> time_step;    // if a vertex is under water

  static constexpr std::uint64_t kListed = 5;
  std::uint64_t total(ModelRule rule) const { return totals[static_cast<std::size_t>(rule)]; }
};

struct ModelInput {
  const Mesh& mesh;
  std::span<const std::int32_t> open_markers{};  // of open boundaries
  std::span<const double> depths{};  // metres, positive down, one a vertex; or empty: unknown
  bool lonlat = false;               // whether coordinates are degrees, otherwise metres
};

// REQUIRES of the mesh: indices in range, three distinct corners per triangle, at most
// HalfEdges::kMaxTriangles triangles; finite coordinates. O(n log n).
ModelReport judge_for_models(const ModelInput& input);

}  // namespace weft::check

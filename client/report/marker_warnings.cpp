// SPDX-License-Identifier: Apache-2.0
#include "client/report/marker_warnings.h"

#include <cstddef>
#include <optional>

#include "client/base/text.h"

namespace weft::client {
namespace {

// "marker 7", "markers 7, 8 and 12 more"; nullopt if `wanted` are all in the mesh.
std::optional<std::string> absent(const std::set<std::int32_t>& wanted,
                                  const std::set<std::int32_t>& in_mesh) {
  constexpr std::size_t kMostNamed = 5;
  std::vector<std::int32_t> markers;
  for (const std::int32_t marker : wanted)
    if (!in_mesh.contains(marker)) markers.push_back(marker);
  if (markers.empty()) return std::nullopt;
  std::string text = markers.size() == 1 ? "marker " : "markers ";
  for (std::size_t i = 0; i < markers.size() && i < kMostNamed; ++i)
    text += (i == 0 ? "" : ", ") + std::to_string(markers[i]);
  if (markers.size() > kMostNamed)
    text += " and " + with_separators(markers.size() - kMostNamed) + " more";
  return text;
}

}  // namespace

std::set<std::int32_t> markers_of(const MeshView& mesh) {
  std::set<std::int32_t> markers;
  for (std::size_t e = 0; e < mesh.edge_markers.size(); ++e)
    if (e == 0 || mesh.edge_markers[e] != mesh.edge_markers[e - 1])
      markers.insert(mesh.edge_markers[e]);
  return markers;
}

std::vector<std::string> open_boundary_warnings(const std::set<std::int32_t>& in_mesh,
                                                std::span<const std::int32_t> open_boundaries) {
  const auto markers = absent({open_boundaries.begin(), open_boundaries.end()}, in_mesh);
  if (!markers) return {};
  return {"no edge of the mesh carries " + *markers + " of --open-boundary"};
}

std::vector<std::string> hidden_marker_warnings(const std::set<std::int32_t>& in_mesh,
                                                const Domain& domain) {
  std::set<std::int32_t> given;
  for (const Domain::Segment& segment : domain.segments)
    if (segment.marker != 0) given.insert(segment.marker);
  const auto markers = absent(given, in_mesh);
  if (!markers) return {};
  return {"no edge of the mesh carries " + *markers +
          " of the input: other segments lie on theirs, or they are not part of what is meshed"};
}

void add_marker_warnings(const MeshView& mesh, std::span<const std::int32_t> open_boundaries,
                         const Domain* domain, MeshReport& report) {
  report.markers = markers_of(mesh);
  add_warnings(open_boundary_warnings(report.markers, open_boundaries), report);
  if (domain != nullptr) add_warnings(hidden_marker_warnings(report.markers, *domain), report);
}

}  // namespace weft::client

// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/middles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "files/base/text.h"

namespace weft::files {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

struct Bend {
  bool on_bisector;  // of the ends, to the rounding of coordinates
  double height;     // of the middle over the chord, over half of its length; 0: straight
};

Bend bend_of(const Mesh& mesh, const std::array<std::uint32_t, 3>& side) {
  const auto at = [&](std::size_t k, std::size_t axis) {
    return mesh.coordinates[2 * std::size_t{side[k]} + axis];
  };
  const double x = at(1, 0) - at(0, 0), y = at(1, 1) - at(0, 1);
  const double off_x = at(2, 0) - (at(0, 0) / 2 + at(1, 0) / 2);
  const double off_y = at(2, 1) - (at(0, 1) / 2 + at(1, 1) / 2);
  double largest = 0;
  for (std::size_t k = 0; k < 3; ++k)
    largest = std::max({largest, std::fabs(at(k, 0)), std::fabs(at(k, 1))});
  const double rounding = 0x1p-50 * largest;
  if (std::max(std::fabs(off_x), std::fabs(off_y)) <= rounding) return {true, 0};
  constexpr double kOnBisector = 1e-9;  // of the length
  const double length = std::sqrt(x * x + y * y);
  const double along = (off_x * x + off_y * y) / length;
  return {std::fabs(along) <= 4 * rounding + kOnBisector * length,
          2 * (off_x * y - off_y * x) / (length * length)};
}

}  // namespace

std::string take_out_middles(const std::string& file, Mesh& mesh) {
  if (mesh.middles.empty()) return "";
  const auto nodes = static_cast<std::uint32_t>(mesh.coordinates.size() / 2);
  std::vector<char> is_middle(nodes, 0);
  for (std::array<std::uint32_t, 3>& side : mesh.middles) {
    if (side[2] >= nodes)
      return "a side has node " + std::to_string(side[2]) + " of " + std::to_string(nodes) +
             " in its middle";
    is_middle[side[2]] = 1;
    if (side[0] > side[1]) std::swap(side[0], side[1]);
  }
  std::sort(mesh.middles.begin(), mesh.middles.end());
  mesh.middles.erase(std::unique(mesh.middles.begin(), mesh.middles.end()), mesh.middles.end());
  for (std::size_t i = 1; i < mesh.middles.size(); ++i)
    if (mesh.middles[i - 1][0] == mesh.middles[i][0] &&
        mesh.middles[i - 1][1] == mesh.middles[i][1])
      return "the side from node " + std::to_string(mesh.middles[i][0]) + " to node " +
             std::to_string(mesh.middles[i][1]) + " has two nodes in its middle";
  for (const std::vector<std::uint32_t>* list : {&mesh.triangles, &mesh.edges, &mesh.faces.corners})
    for (const std::uint32_t v : *list)
      if (is_middle[v] != 0)
        return "node " + std::to_string(v) + " is the middle of a side, and the end of one";

  const auto is_bent = [](const Bend& bend) { return !bend.on_bisector || bend.height != 0; };
  auto bent = static_cast<std::size_t>(std::ranges::count_if(
      mesh.middles, [&](const auto& side) { return is_bent(bend_of(mesh, side)); }));
  mesh.edge_bulges.assign(mesh.edges.size() / 2, 0);
  for (std::size_t e = 0; e < mesh.edge_bulges.size(); ++e) {
    const auto [low, high] = std::minmax(mesh.edges[2 * e], mesh.edges[2 * e + 1]);
    const auto side =
        std::lower_bound(mesh.middles.begin(), mesh.middles.end(), std::array{low, high, 0u});
    if (side == mesh.middles.end() || (*side)[0] != low || (*side)[1] != high) continue;
    const Bend bend = bend_of(mesh, *side);
    if (!bend.on_bisector || !(std::fabs(bend.height) <= 1)) continue;
    mesh.edge_bulges[e] = mesh.edges[2 * e] == low ? bend.height : -bend.height;
    bent -= is_bent(bend);
  }
  if (std::ranges::none_of(mesh.edge_bulges, [](double bulge) { return bulge != 0; }))
    mesh.edge_bulges.clear();
  if (bent > 0)
    mesh.warnings.push_back(
        {.kind = WarningKind::kLeftOut,
         .file = file,
         .count = bent,
         .text = with_separators(bent) + (bent == 1 ? " bent side is" : " bent sides are") +
                 " read as straight: only edges with a node on their bisector are arcs"});

  std::vector<std::uint32_t> number(nodes, kNone);
  for (std::uint32_t node = 0; node < nodes; ++node) {
    if (is_middle[node] != 0) continue;
    const std::size_t v = mesh.nodes.size();
    number[node] = static_cast<std::uint32_t>(v);
    mesh.coordinates[2 * v] = mesh.coordinates[2 * std::size_t{node}];
    mesh.coordinates[2 * v + 1] = mesh.coordinates[2 * std::size_t{node} + 1];
    mesh.nodes.push_back(node);
  }
  mesh.coordinates.resize(2 * mesh.nodes.size());
  for (std::vector<std::uint32_t>* list : {&mesh.triangles, &mesh.edges, &mesh.faces.corners})
    for (std::uint32_t& v : *list) v = number[v];
  mesh.middles = {};
  return "";
}

std::vector<double> at_vertices(const Mesh& mesh, std::vector<double> at_nodes) {
  if (mesh.nodes.empty()) return at_nodes;
  std::vector<double> values;
  values.reserve(mesh.nodes.size());
  for (const std::uint32_t node : mesh.nodes)
    values.push_back(node < at_nodes.size() ? at_nodes[node]
                                            : std::numeric_limits<double>::quiet_NaN());
  return values;
}

}  // namespace weft::files

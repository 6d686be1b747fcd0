// SPDX-License-Identifier: Apache-2.0
#include "client/formats/derived/middles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "client/base/text.h"

namespace weft::client {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

struct Bend {
  double along, aside;  // of the middle, from that of the chord, over half of its length
};

Bend bend_of(const Mesh& mesh, const std::array<std::uint32_t, 3>& side) {
  const auto at = [&](std::size_t k, std::size_t axis) {
    return mesh.coordinates[2 * std::size_t{side[k]} + axis];
  };
  const double x = at(1, 0) - at(0, 0), y = at(1, 1) - at(0, 1);
  const double off_x = at(2, 0) - (at(0, 0) / 2 + at(1, 0) / 2);
  const double off_y = at(2, 1) - (at(0, 1) / 2 + at(1, 1) / 2);
  const double scale = 2 / (x * x + y * y);
  // Straight sides, up to the rounding of the coordinates.
  double largest = 0;
  for (std::size_t k = 0; k < 3; ++k)
    largest = std::max({largest, std::fabs(at(k, 0)), std::fabs(at(k, 1))});
  if (std::max(std::fabs(off_x), std::fabs(off_y)) <= 0x1p-50 * largest) return {0, 0};
  return {scale * (off_x * x + off_y * y), scale * (off_x * y - off_y * x)};
}

}  // namespace

std::string take_out_middles(Mesh& mesh) {
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

  constexpr double kOnBisector = 1e-9;
  std::size_t bent = 0;
  for (const auto& side : mesh.middles) {
    const Bend bend = bend_of(mesh, side);
    bent += bend.along != 0 || bend.aside != 0;
  }
  mesh.edge_bulges.assign(mesh.edges.size() / 2, 0);
  for (std::size_t e = 0; e < mesh.edge_bulges.size(); ++e) {
    const auto [low, high] = std::minmax(mesh.edges[2 * e], mesh.edges[2 * e + 1]);
    const auto side =
        std::lower_bound(mesh.middles.begin(), mesh.middles.end(), std::array{low, high, 0u});
    if (side == mesh.middles.end() || (*side)[0] != low || (*side)[1] != high) continue;
    const Bend bend = bend_of(mesh, *side);
    if (std::fabs(bend.along) > kOnBisector || !(std::fabs(bend.aside) <= 1)) continue;
    mesh.edge_bulges[e] = mesh.edges[2 * e] == low ? bend.aside : -bend.aside;
    bent -= bend.along != 0 || bend.aside != 0;
  }
  if (std::ranges::none_of(mesh.edge_bulges, [](double bulge) { return bulge != 0; }))
    mesh.edge_bulges.clear();
  if (bent > 0)
    mesh.warnings.push_back(
        {.kind = WarningKind::kLeftOut,
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

}  // namespace weft::client

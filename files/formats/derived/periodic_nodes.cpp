// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/periodic_nodes.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <unordered_set>

namespace weft::files {
namespace {

using Place = std::complex<double>;

constexpr double kTolerance = 1e-9;  // of the extent

Place place_of(const MeshView& mesh, std::uint32_t node) {
  return {mesh.coordinates[2 * std::size_t{node}], mesh.coordinates[2 * std::size_t{node} + 1]};
}

std::uint64_t key_of(std::uint64_t a, std::uint64_t b) {
  return a << 32 | b;
}

// The edges with a marker.
struct Side {
  Side(const MeshView& mesh, std::int32_t marker) {
    const std::size_t each = mesh.edge_nodes();
    for (const std::size_t e : mesh.up_to(mesh.edge_count())) {
      if (mesh.edge_markers[e] != marker) continue;
      const auto of_edge = mesh.edges.subspan(e * each, each);
      nodes.insert(nodes.end(), of_edge.begin(), of_edge.end());
      edges.insert(key_of(of_edge[0], of_edge[1]));
      edges.insert(key_of(of_edge[1], of_edge[0]));
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    for (const std::uint32_t node : nodes) mean += place_of(mesh, node);
    if (!nodes.empty()) mean /= static_cast<double>(nodes.size());
  }

  std::vector<std::uint32_t> nodes;         // ascending
  std::unordered_set<std::uint64_t> edges;  // in both directions
  Place mean;
  Place along;  // the sum of its edges, the mesh on their left
};

void find_directions(const MeshView& mesh, Side& first, Side& second) {
  std::vector<bool> near(mesh.vertex_count());
  for (const Side* side : {&first, &second})
    for (const std::uint32_t node : side->nodes) near[node] = true;
  const std::size_t each = mesh.triangle_nodes();
  for (const std::size_t t : mesh.up_to(mesh.triangle_count()))
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[t * each + k];
      const std::uint32_t b = mesh.triangles[t * each + (k + 1) % 3];
      if (!near[a] || !near[b]) continue;
      for (Side* side : {&first, &second})
        if (side->edges.contains(key_of(a, b)))
          side->along += place_of(mesh, b) - place_of(mesh, a);
    }
}

// By x.
std::vector<std::uint32_t> sorted(const MeshView& mesh, std::vector<std::uint32_t> nodes) {
  std::sort(nodes.begin(), nodes.end(), [&](std::uint32_t a, std::uint32_t b) {
    return place_of(mesh, a).real() < place_of(mesh, b).real();
  });
  return nodes;
}

// Empty if a node has no image, or two have the same.
std::vector<std::array<std::uint32_t, 2>> match(const MeshView& mesh, const Side& first,
                                                const Side& second, Place turn, Place shift,
                                                double tolerance) {
  std::vector<std::array<std::uint32_t, 2>> pairs;
  if (first.nodes.size() != second.nodes.size()) return pairs;
  const std::vector<std::uint32_t> by_x = sorted(mesh, second.nodes);
  std::vector<bool> taken(by_x.size());
  for (const std::uint32_t node : first.nodes) {
    const Place image = turn * place_of(mesh, node) + shift;
    auto at = std::lower_bound(
        by_x.begin(), by_x.end(), image.real() - tolerance,
        [&](std::uint32_t other, double x) { return place_of(mesh, other).real() < x; });
    const auto fits = [&](auto it) {
      return !taken[static_cast<std::size_t>(it - by_x.begin())] &&
             std::abs(place_of(mesh, *it) - image) <= tolerance;
    };
    while (at != by_x.end() && place_of(mesh, *at).real() <= image.real() + tolerance && !fits(at))
      ++at;
    if (at == by_x.end() || !fits(at)) return {};
    taken[static_cast<std::size_t>(at - by_x.begin())] = true;
    pairs.push_back({node, *at});
  }
  return pairs;
}

double extent_of(const MeshView& mesh) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double low[2] = {kInfinity, kInfinity}, high[2] = {-kInfinity, -kInfinity};
  for (const std::size_t i : mesh.up_to(mesh.coordinates.size())) {
    low[i % 2] = std::min(low[i % 2], mesh.coordinates[i]);
    high[i % 2] = std::max(high[i % 2], mesh.coordinates[i]);
  }
  return std::max(high[0] - low[0], high[1] - low[1]);
}

}  // namespace

std::vector<PeriodicNodes> periodic_nodes(const MeshView& mesh,
                                          std::span<const std::array<std::int32_t, 2>> sides) {
  std::vector<PeriodicNodes> found;
  if (sides.empty()) return found;
  const double tolerance = kTolerance * extent_of(mesh);
  for (const auto& markers : sides) {
    Side first(mesh, markers[0]), second(mesh, markers[1]);
    find_directions(mesh, first, second);
    // The images of edges are those of the other side, the other way around.
    Place turn = -second.along / first.along;
    const double length = std::abs(first.along);
    if (!(length > tolerance) || std::abs(turn - 1.0) * length <= tolerance) turn = 1;
    turn /= std::abs(turn);
    const Place shift = second.mean - turn * first.mean;
    PeriodicNodes nodes{markers, turn.real(), turn.imag(), shift.real(), shift.imag()};
    nodes.pairs = match(mesh, first, second, turn, shift, tolerance);
    if (!nodes.pairs.empty()) found.push_back(std::move(nodes));
  }
  return found;
}

}  // namespace weft::files

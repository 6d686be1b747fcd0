// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/second_order.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <limits>
#include <system_error>
#include <utility>

namespace weft::files {
namespace {

struct Vector {
  double x, y;
  friend Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y}; }
};
double cross(Vector a, Vector b) {
  return a.x * b.y - a.y * b.x;
}

}  // namespace

SecondOrderMesh::SecondOrderMesh(const MeshView& mesh) : mesh_(mesh) {
  const MeshEdges edges(mesh);
  if (mesh.vertex_count() + edges.size() > std::numeric_limits<std::uint32_t>::max())
    throw std::system_error(EOVERFLOW, std::generic_category());
  const auto vertices = static_cast<std::uint32_t>(mesh.vertex_count());
  coordinates_ = ScratchArray<double>(mesh.pages, mesh.coordinates.size() + 2 * edges.size());
  std::size_t next = 0;
  for (const std::size_t i : mesh.up_to(mesh.coordinates.size()))
    coordinates_[next++] = mesh.coordinates[i];
  Jumps jumps(mesh.pages);
  for (const std::size_t e : mesh.up_to(edges.size())) {
    jumps.to(edges.high(e));
    for (std::size_t axis = 0; axis < 2; ++axis)
      coordinates_[next++] = mesh.coordinates[2 * std::size_t{edges.low(e)} + axis] / 2 +
                             mesh.coordinates[2 * std::size_t{edges.high(e)} + axis] / 2;
  }

  for (const VertexValues& values : mesh.vertex_values) {
    ScratchArray<double> at(mesh.pages, coordinates_.size() / 2);
    for (const std::size_t v : mesh.up_to(vertices)) at[v] = values.values[v];
    for (const std::size_t e : mesh.up_to(edges.size())) {
      jumps.to(edges.high(e));
      at[vertices + e] = values.values[edges.low(e)] / 2 + values.values[edges.high(e)] / 2;
    }
    vertex_values_.push_back({values.name, at.values()});
    arrays_.push_back(std::move(at));
  }

  triangles_ = ScratchArray<std::uint32_t>(mesh.pages, 2 * mesh.triangles.size());
  for (const std::size_t t : mesh.up_to(mesh.triangle_count()))
    for (std::size_t k = 0; k < 3; ++k) {
      triangles_[6 * t + k] = mesh.triangles[3 * t + k];
      triangles_[6 * t + 3 + k] = vertices + edges.of_side(3 * t + k);
    }
  edges_ = ScratchArray<std::uint32_t>(mesh.pages, 3 * mesh.edge_count());
  for (const std::size_t i : mesh.up_to(mesh.edge_count())) {
    edges_[3 * i] = mesh.edges[2 * i];
    edges_[3 * i + 1] = mesh.edges[2 * i + 1];
    edges_[3 * i + 2] = vertices + edges.of_input_edge(i);
  }
  if (!mesh.edge_bulges.empty()) bend(edges);
}

void SecondOrderMesh::bend(const MeshEdges& edges) {
  enum State : std::uint8_t { kStraight, kBent, kRefused };
  ScratchArray<std::uint8_t> state(mesh_.pages, edges.size());  // kStraight
  const auto place = [&](std::size_t i, double bulge) {
    const std::array<std::size_t, 3> node{edges_[3 * i], edges_[3 * i + 1], edges_[3 * i + 2]};
    const auto at = [&](std::size_t k) -> double* { return &coordinates_[2 * node[k]]; };
    const Vector a{at(0)[0], at(0)[1]}, b{at(1)[0], at(1)[1]};
    at(2)[0] = a.x / 2 + b.x / 2 + bulge / 2 * (b.y - a.y);
    at(2)[1] = a.y / 2 + b.y / 2 - bulge / 2 * (b.x - a.x);
    state[edges.of_input_edge(i)] = bulge == 0 ? kStraight : kBent;
  };
  const std::span bulges = mesh_.edge_bulges;
  for (const std::size_t i : mesh_.up_to(bulges.size()))
    if (bulges[i] != 0) place(i, bulges[i]);
  std::size_t before = 0;
  do {
    before = straightened_;
    for (const std::size_t t : mesh_.up_to(mesh_.triangle_count())) {
      const std::array<std::uint32_t, 3> side{edges.of_side(3 * t), edges.of_side(3 * t + 1),
                                              edges.of_side(3 * t + 2)};
      const auto is_bent = [&](std::uint32_t e) { return state[e] != kStraight; };
      if (std::ranges::any_of(side, is_bent) && turns_over(t))
        for (const std::uint32_t e : side)
          if (is_bent(e)) state[e] = kRefused;
    }
    for (const std::size_t i : mesh_.up_to(bulges.size())) {
      if (state[edges.of_input_edge(i)] != kRefused) continue;
      place(i, 0);
      ++straightened_;
    }
  } while (straightened_ != before);
}

// The coefficients are products of the derivatives in two directions, which are linear: (u1 x v1),
// (u1 x v2 + u2 x v1) / 2 and so on, from their values at the corners.
bool SecondOrderMesh::turns_over(std::size_t t) const {
  std::array<Vector, 6> p;  // the corners, then the control points of the sides
  for (std::size_t k = 0; k < 6; ++k) {
    const std::size_t node = triangles_[6 * t + k];
    p[k] = {coordinates_[2 * node], coordinates_[2 * node + 1]};
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector a = p[k], b = p[(k + 1) % 3];
    p[3 + k] = {2 * p[3 + k].x - (a.x + b.x) / 2, 2 * p[3 + k].y - (a.y + b.y) / 2};
  }
  const std::array<Vector, 3> u{p[3] - p[0], p[1] - p[3], p[4] - p[5]};
  const std::array<Vector, 3> v{p[5] - p[0], p[4] - p[3], p[2] - p[5]};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = i; j < 3; ++j)
      if (!(cross(u[i], v[j]) + cross(u[j], v[i]) > 0)) return true;
  return false;
}

MeshView SecondOrderMesh::view() const {
  MeshView view = mesh_;
  view.coordinates = coordinates_.values();
  view.triangles = triangles_.values();
  view.edges = edges_.values();
  view.vertex_values = vertex_values_;
  view.order = 2;
  return view;
}

CornerMesh::CornerMesh(const MeshView& mesh) : view_(mesh) {
  if (mesh.order == 1) return;
  triangles_ = ScratchArray<std::uint32_t>(mesh.pages, 3 * mesh.triangle_count());
  for (const std::size_t t : mesh.up_to(mesh.triangle_count()))
    for (std::size_t k = 0; k < 3; ++k)
      triangles_[3 * t + k] = mesh.triangles[mesh.triangle_nodes() * t + k];
  edges_ = ScratchArray<std::uint32_t>(mesh.pages, 2 * mesh.edge_count());
  for (const std::size_t e : mesh.up_to(mesh.edge_count()))
    for (std::size_t k = 0; k < 2; ++k) edges_[2 * e + k] = mesh.edges[mesh.edge_nodes() * e + k];
  view_.triangles = triangles_.values();
  view_.edges = edges_.values();
  view_.order = 1;
}

}  // namespace weft::files

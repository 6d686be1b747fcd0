// SPDX-License-Identifier: Apache-2.0
#include "client/formats/derived/second_order.h"

#include <cerrno>
#include <limits>
#include <system_error>
#include <utility>

#include "client/formats/derived/mesh_edges.h"

namespace weft::client {

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

}  // namespace weft::client

// SPDX-License-Identifier: Apache-2.0
#include "client/formats/second_order.h"

#include "client/formats/mesh_edges.h"

namespace weft::client {

SecondOrderMesh::SecondOrderMesh(const MeshView& mesh) : mesh_(mesh) {
  const MeshEdges edges(mesh);
  const auto vertices = static_cast<std::uint32_t>(mesh.vertex_count());
  coordinates_.reserve(mesh.coordinates.size() + 2 * edges.size());
  coordinates_.assign(mesh.coordinates.begin(), mesh.coordinates.end());
  for (std::size_t e = 0; e < edges.size(); ++e)
    for (std::size_t axis = 0; axis < 2; ++axis)
      coordinates_.push_back(mesh.coordinates[2 * std::size_t{edges.low(e)} + axis] / 2 +
                             mesh.coordinates[2 * std::size_t{edges.high(e)} + axis] / 2);

  triangles_.reserve(2 * mesh.triangles.size());
  for (std::size_t first = 0; first < mesh.triangles.size(); first += 3) {
    for (std::size_t k = 0; k < 3; ++k) triangles_.push_back(mesh.triangles[first + k]);
    for (std::size_t k = 0; k < 3; ++k) triangles_.push_back(vertices + edges.of_side(first + k));
  }
  edges_.reserve(3 * mesh.edge_count());
  for (std::size_t i = 0; i < mesh.edge_count(); ++i) {
    edges_.push_back(mesh.edges[2 * i]);
    edges_.push_back(mesh.edges[2 * i + 1]);
    edges_.push_back(vertices + edges.of_input_edge(i));
  }
}

MeshView SecondOrderMesh::view() const {
  MeshView view = mesh_;
  view.coordinates = coordinates_;
  view.triangles = triangles_;
  view.edges = edges_;
  view.order = 2;
  return view;
}

}  // namespace weft::client

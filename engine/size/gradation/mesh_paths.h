// SPDX-License-Identifier: Apache-2.0
// Lengths of paths through a mesh, which turn only where they have to.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "engine/base/context.h"
#include "engine/size/fields/mesh_field.h"
#include "weft/error.h"

namespace weft {

// The triangles around each vertex.
class VertexTriangles {
 public:
  explicit VertexTriangles(const FieldMesh& mesh);
  template <class F>
  void around(std::uint32_t v, F f) const {
    for (std::uint32_t i = first_[v]; i < first_[v + 1]; ++i) f(triangles_[i]);
  }

 private:
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> triangles_;
};

// Lowers each value of the mesh to the least, over its vertices, of value + growth * (length of a
// path in the mesh). Straight ways are carried from triangle to triangle by E. W. Dijkstra's order,
// each with the vertex, its apex, at which it begins; a way that would cross land turns at a vertex
// of the border, an apex with an apex of its own. Nearly exact: beside the shadow of a vertex a way
// may pass through land for less than an edge, and between apexes the least may be missed.
class MeshPaths {
 public:
  MeshPaths(FieldMesh& mesh, const VertexTriangles& triangles, double growth);

  std::optional<Error> run(const ExecutionContext& context);

 private:
  using Open = std::pair<double, std::uint32_t>;

  double turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
  void carry(std::uint32_t apex, std::uint32_t to);
  void carry_across(std::uint32_t near, std::uint32_t far, std::uint32_t to);
  void reach(std::uint32_t v);

  FieldMesh& mesh_;
  const VertexTriangles& triangles_;
  const double growth_;
  std::vector<std::uint32_t> apex_;  // per vertex; itself, if a path begins there
  std::vector<bool> reached_;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open_;
};

}  // namespace weft

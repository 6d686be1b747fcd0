// SPDX-License-Identifier: Apache-2.0
// How the triangles of a mesh are connected. Half-edge 3t + i runs from corner i of triangle t to
// its next corner, with the triangle on its left. About 16 bytes per half-edge.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "checker/mesh.h"
#include "checker/report.h"

namespace weft::check {

// REQUIRES of the mesh: indices in range, three distinct corners per triangle.
class HalfEdges {
 public:
  static constexpr std::uint32_t kMaxTriangles = 0xffffffffu / 3;

  explicit HalfEdges(const Mesh& mesh);

  // Adds a violation of kConformity for every edge with more than two triangles, or with two on the
  // same side; returns false if there is one. `twin` and `find` may be called only after true.
  bool judge_conformity(Findings& findings);

  std::uint32_t size() const { return static_cast<std::uint32_t>(twin_.size()); }
  std::uint32_t start(std::uint32_t h) const { return mesh_.triangles[h / 3][h % 3]; }
  std::uint32_t end(std::uint32_t h) const { return mesh_.triangles[h / 3][(h % 3 + 1) % 3]; }
  bool has_twin(std::uint32_t h) const { return twin_[h] != kNoTwin; }
  // The half-edge of the triangle on the other side. REQUIRES: has_twin(h).
  std::uint32_t twin(std::uint32_t h) const { return twin_[h]; }
  // A half-edge between two vertices, in either direction.
  std::optional<std::uint32_t> find(std::uint32_t a, std::uint32_t b) const;

 private:
  static constexpr std::uint32_t kNoTwin = 0xffffffffu;

  struct Entry {
    std::uint32_t high;  // the end with the higher number
    std::uint32_t half_edge;
    auto operator<=>(const Entry&) const = default;
  };

  const Mesh& mesh_;
  std::vector<std::uint32_t> first_;  // entries_ by the end with the lower number
  std::vector<Entry> entries_;        // sorted for each
  std::vector<std::uint32_t> twin_;
};

}  // namespace weft::check

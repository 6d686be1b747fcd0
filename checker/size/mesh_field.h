// SPDX-License-Identifier: Apache-2.0
// A field that is linear in each triangle of a mesh; outside of all, its value is that of the
// mesh's nearest point. Of triangles that hold the same point, the first counts. Undefined (NaN) in
// a triangle with a corner that is NaN, and in what is nearest to it. Flat triangles, of an area of
// at most 2^-40 of their longest side's square, are left out. Independent of the engine's.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "checker/domain.h"
#include "checker/geometry/box_tree.h"

namespace weft::check {

struct MeshField {
  std::vector<Vec2> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // in either orientation
  std::vector<double> values;                           // one per vertex
};

class MeshValues {
 public:
  // Errors: a sentence about an index out of range, a coordinate that is not finite, another number
  // of values than of vertices, or no triangle that is not flat. REQUIRES: `field` outlives the
  // object.
  static tl::expected<MeshValues, std::string> make(const MeshField& field);

  double value(Vec2 p) const;
  // The length of the gradient of the same triangle.
  double slope(Vec2 p) const;

 private:
  // A point of a triangle by the weights of its corners, and how far it is.
  struct Place {
    double distance = 0;
    std::array<double, 3> weights{};
  };

  MeshValues(const MeshField& field, std::vector<std::uint32_t> used, std::vector<Box> boxes)
      : field_(&field), used_(std::move(used)), tree_(std::move(boxes)) {}
  std::array<Vec2, 3> corners(std::uint32_t triangle) const;
  // The triangle that counts at p.
  std::uint32_t nearest(Vec2 p) const;

  static Place nearest_in(const std::array<Vec2, 3>& corners, Vec2 p);

  const MeshField* field_;
  std::vector<std::uint32_t> used_;  // triangles, in ascending order: those of the tree
  BoxTree tree_;
};

}  // namespace weft::check

// SPDX-License-Identifier: Apache-2.0
// A field on an earlier mesh: linear in its triangles, from values at its vertices.
//
// At a point that several triangles hold, which are closed, the one with the lowest number counts.
// At a point that no triangle holds, the value is that of the nearest point of the mesh, however
// far (of several triangles as near, that with the lowest number), so that a new mesh of the same
// domain has a value at every point: its border is rounded otherwise than that of the old one.
// Beyond 2^20 times the mesh's extent each coordinate counts as if it were there. A vertex whose
// value is NaN makes its triangles undefined, and what they are nearest to.
//
// The triangles may be oriented as they like, overlap, repeat and leave gaps; one that is flat (its
// area is at most 2^-40 of its longest edge's square) is left out.
//
// The slope is that of the triangle, also where it is only the nearest.
//
//   auto h = MeshField::make({vertices, triangles, values}, "size.fields[0].mesh", context);
//   double value = (*h)({0.5, 0.5});
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/context.h"
#include "engine/size/field.h"
#include "engine/size/fields/triangle_cells.h"
#include "engine/size/fields/triangle_tree.h"
#include "weft/error.h"
#include "weft/size.h"

namespace weft {

class MeshField final : public Field {
 public:
  // `path` is that of the mesh in the request. Errors: kBadOption with the field "PATH.values" if
  // there is not one for each vertex, or "PATH.triangles" if there are more than 2^30, or none that
  // is not flat; kBadCoordinate with "PATH.vertices[i].x" or ".y" if it is not finite or beyond
  // 1e50; kIndexOutOfRange with "PATH.triangles[i]"; kBadSizeValue with "PATH.values[i]" if it is
  // infinite; those of the context. Same bits on any number of threads.
  static Result<MeshField> make(FieldMesh mesh, const std::string& path,
                                const ExecutionContext& context);

  void evaluate(std::size_t n, const double* x, const double* y,
                double* out) const noexcept override;
  Interval bounds(const Box& box) const noexcept override;
  // Infinity for a box that meets the border of the mesh or lies outside, or meets an edge of which
  // not just two triangles lie on two sides, or two layers of triangles.
  double steepness(const Box& box) const noexcept override;
  std::unique_ptr<const Field> slope() const override;
  std::size_t bytes() const noexcept override;
  // Measured when it is made: the mean over some hundred of points.
  std::size_t operations() const noexcept override { return operations_; }

  // What `make` takes at most, the mesh itself not counted.
  static std::uint64_t bytes_to_make(std::uint64_t triangles) {
    return TriangleTree::bytes_to_build(triangles) + TriangleCells::bytes_to_build(triangles) +
           100 * triangles;
  }

  // As `evaluate` and `bounds`, of the length of the gradient.
  double slope_at(Point p) const noexcept;
  Interval slope_bounds(const Box& box) const noexcept;

 private:
  // What is known of an item of the tree, or of a triangle in a box.
  struct Hull {
    Interval value;
    Interval slope;
    bool at_border;  // an edge of which not just two triangles lie on two sides
  };
  // The triangles that may give a value in a box.
  struct Look {
    Hull hull;
    bool one_layer;  // each point of the box is in just one triangle, but for edges
  };

  explicit MeshField(FieldMesh mesh) : mesh_(std::move(mesh)) {}
  std::optional<Error> check(const std::string& path, const ExecutionContext& context) const;
  std::optional<Error> build(const std::string& path, const ExecutionContext& context);
  std::optional<Error> find_border(const ExecutionContext& context);
  std::optional<Error> add_hulls(const ExecutionContext& context);
  void measure();

  Point brought_near(Point p) const noexcept;
  TriangleTree::Found find(Point p) const noexcept;
  double value_in(std::uint32_t place, Point p) const noexcept;
  double slope_of(std::uint32_t place) const noexcept;
  double vertex_value(std::uint32_t place, int k) const noexcept {
    return mesh_.values[tree_.triangles()[place].vertex[static_cast<std::size_t>(k)]];
  }
  Point gradient_of(std::uint32_t place) const noexcept;
  double value_at(Point p) const noexcept;
  Hull hull_of(std::uint32_t place) const noexcept;
  Hull hull_in(std::uint32_t place, const Box& box) const noexcept;
  Hull hull_over(const Box& box) const noexcept;
  Look look(const Box& box) const noexcept;

  FieldMesh mesh_;     // its triangles are empty, because the tree holds them
  TriangleTree tree_;  // refers to the vertices, which stay where they are when the mesh moves
  TriangleCells cells_;
  std::vector<std::uint8_t> border_;      // of each place, a bit for each of its edges
  std::vector<std::vector<Hull>> hulls_;  // [level]: of the tree's items
  Box within_;                            // where coordinates count as they are
  double rounding_ = 0;                   // of a point's place
  std::size_t operations_ = 0;
};

}  // namespace weft

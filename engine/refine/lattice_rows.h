// SPDX-License-Identifier: Apache-2.0
// Rows of lattice triangles, written into the mesh at once.
//
// Deep inside a leaf with one size, refinement inserts one lattice point after the other, and each
// insertion replaces four triangles by six. The result is known beforehand: the lattice. So a
// rectangle of it (LatticeRectangle) is made in three steps:
//
//   1. The caller makes the lattice points of the rectangle's border, its ring, vertices, by
//      ordinary insertions (row_filler.h).
//   2. The edges between neighbours on the ring are looked up in the mesh, and the triangles
//      inside are collected from these edges inwards.
//   3. If nothing but vertices of the lattice lies inside, the rest of its points are added, and
//      two triangles per point replace those that were found.
//
// Nothing is changed before step 3, and the mesh is constrained Delaunay after it as before. No
// point is off the lattice by more than kMaxJitter each way, so the rows' triangles are acute
// (at most 85 degrees, at least 39). Step 2 makes sure that the vertex beyond each edge of the ring
// sees it at 90 degrees at most. So the two angles opposite an edge of the rows add up to less than
// 180 degrees, and every edge is locally Delaunay. No segment lies inside, because every edge that
// is crossed is looked at; no input point, because all vertices that are found stay.
//
// Ownership (ownership.h): the task owns the vertices of the ring, and its box is convex, so it
// owns all vertices inside. Of a triangle beyond the ring it owns two, and writes the mark and the
// link. New triangles take the slots of those that the task replaces, and new ones; those of other
// owners die. So a slot may get a triangle whose three vertices are of earlier owners, which
// insertions never make.
//
// The result depends on the mesh alone: on no clock, no address and no other task.
// Thread-safety: one LatticeRows per task.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/base/geometry.h"
#include "engine/refine/ownership.h"
#include "engine/refine/storage/mesh_store.h"
#include "engine/refine/storage/slots.h"
#include "engine/size/lattice/lattice.h"

namespace weft {

// A rectangle of points of the lattice through the origin, in rows of equal length.
struct LatticeRectangle {
  static constexpr std::uint32_t kMin = 10;  // rows, and points in a row
  static constexpr std::uint32_t kMaxPoints = std::uint32_t{1} << 16;
  static constexpr double kMaxJitter = 0.1;  // spacings, with rounding

  double first_column = 0;  // of the lattice
  double first_row = 0;
  std::uint32_t columns = 0;  // points in a row
  std::uint32_t rows = 0;
  double spacing = 0;
  double jitter = 0;  // spacings

  // The largest one a spacing inside the box. Returns nullopt if it has fewer than kMin rows or
  // columns or more than kMaxPoints points, or if coordinates there are too coarse for it.
  static std::optional<LatticeRectangle> in(const Box& box, double spacing, double jitter);

  Point at(std::uint32_t column, std::uint32_t row) const {
    const Complex p =
        lattice_point(first_column + column, first_row + row, is_shifted(row) ? 0.5 : 0, jitter);
    return {p.re * spacing, p.im * spacing};
  }
  // The place of a point in the rectangle, row by row; kNone if it is none of its points.
  std::uint32_t place_of(Point p) const;
  // Whether the points of a row lie half a spacing to the right.
  bool is_shifted(std::uint32_t row) const;
  // The places of the border's points, counter-clockwise from the first one.
  void append_ring(std::vector<std::uint32_t>& ring) const;

  std::uint32_t points() const { return columns * rows; }
  std::uint32_t triangles() const { return 2 * (columns - 1) * (rows - 1); }
};

class LatticeRows {
 public:
  explicit LatticeRows(MeshStore& mesh) : mesh_(mesh) {}

  // Begins a task: new triangles and vertices go to `slots`.
  void begin(Slots& slots, const OwnsBox& ownership) {
    slots_ = &slots;
    ownership_ = ownership;
  }

  // The triangle that contains p, by a walk from another one; kNone if a segment or a triangle that
  // is not owned is in the way. REQUIRES: the task may read the triangle `from`.
  std::uint32_t locate(Point p, std::uint32_t from) const;
  // The vertex of a triangle that is at p, or kNone.
  std::uint32_t vertex_at(Point p, std::uint32_t triangle) const;
  bool owns(std::uint32_t triangle) const;

  // Begins a rectangle: no point of it is known as a vertex.
  void lay_out(const LatticeRectangle& rectangle);
  std::size_t ring_size() const { return ring_.size(); }
  Point ring_point(std::size_t k) const {
    return rectangle_.at(ring_[k] % rectangle_.columns, ring_[k] / rectangle_.columns);
  }
  void set_ring_vertex(std::size_t k, std::uint32_t vertex) { vertex_[ring_[k]] = vertex; }

  struct Gain {
    std::uint32_t vertices = 0;
    std::int64_t triangles = 0;
  };
  // Replaces what is inside the ring by rows. Returns nullopt if that is not possible: then the
  // mesh is as before. REQUIRES: all points of the ring are vertices; `near` is a triangle near the
  // first one.
  std::optional<Gain> fill(std::uint32_t near);
  // The triangles that `fill` has made.
  const std::uint32_t* begin_made() const { return slots_of_rows_.data() + 1; }
  const std::uint32_t* end_made() const { return begin_made() + rectangle_.triangles(); }

  std::uint64_t bytes() const;

 private:
  // These return whether rows are still possible.
  bool find_ring(std::uint32_t near);
  bool collect_inside();

  std::uint32_t add_vertices();
  std::int64_t take_slots();
  void write_rows();
  void link(std::uint32_t triangle, std::uint32_t edge, HalfEdge outside);

  MeshStore& mesh_;
  Slots* slots_ = nullptr;
  OwnsBox ownership_{};
  LatticeRectangle rectangle_;
  std::vector<std::uint32_t> vertex_;   // per point, or kNone
  std::vector<std::uint32_t> ring_;     // places of the points
  std::vector<HalfEdge> inside_edges_;  // per edge of the ring
  std::vector<HalfEdge> outside_edges_;
  std::vector<std::uint32_t> inside_;  // triangles
  std::vector<std::uint32_t> beyond_;  // triangles beyond the ring
  std::uint32_t region_ = 0;
  std::vector<std::uint32_t> slots_of_rows_;  // between two that stand for no slot
};

}  // namespace weft

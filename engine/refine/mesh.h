// SPDX-License-Identifier: GPL-3.0-or-later
// The mesh that refinement works on: 32 bytes a triangle, 16 bytes a vertex, so 40 bytes a
// triangle.
//
// Triangles are counter-clockwise; edge i is opposite vertex[i], from vertex[i+1] to vertex[i+2].
// A half-edge names a triangle and one of its edges in one word. There is no free list and no dead
// triangle: the slots of a cavity are taken by the triangles that replace it.
//
// Vertices that refinement puts on segments are numbered down from the top of the array, all
// others up from the bottom: so what a vertex is shows in its number, and the few on segments can
// remember their subsegment without costing the many anything.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "engine/context.h"
#include "engine/domain/domain.h"
#include "engine/error.h"
#include "engine/geometry.h"
#include "engine/refine/virtual_array.h"

namespace weft {

// Triangle index and edge index (0 to 2) in one word; kNone is no half-edge.
using HalfEdge = std::uint32_t;
inline constexpr HalfEdge half_edge(std::uint32_t triangle, std::uint32_t edge) {
  return triangle << 2 | edge;
}
inline constexpr std::uint32_t triangle_of(HalfEdge h) {
  return h >> 2;
}
inline constexpr std::uint32_t edge_of(HalfEdge h) {
  return h & 3;
}

// The index after and before i in {0, 1, 2}.
inline constexpr std::uint8_t kNext[4] = {1, 2, 0, 0};
inline constexpr std::uint8_t kPrevious[4] = {2, 0, 1, 0};

// What a triangle misses. A triangle with a badness other than kGood has an entry in a queue.
enum class Badness : std::uint32_t { kGood = 0, kSkinny = 1, kLarge = 2 };

// Why a triangle stays bad.
enum class Excuse : std::uint32_t { kNone = 0, kSmallInputAngle = 1, kEdgeFloor = 2 };

struct alignas(32) Triangle {
  std::uint32_t vertex[3];
  std::uint32_t flags;  // bits 0-2: edge i lies on a segment; 4-5: Excuse; 8-15: Badness
  HalfEdge neighbor[3];
  std::uint32_t region;  // index into Domain::regions

  bool on_segment(std::uint32_t edge) const { return flags >> edge & 1; }
  std::uint32_t segment_bits() const { return flags & 7; }
  Badness badness() const { return static_cast<Badness>(flags >> 8); }
  Excuse excuse() const { return static_cast<Excuse>(flags >> 4 & 3); }
  void set_badness(Badness b) { flags = (flags & 0xff) | static_cast<std::uint32_t>(b) << 8; }
  // An excused triangle is no longer to be refined.
  void set_excuse(Excuse e) { flags = (flags & 7) | static_cast<std::uint32_t>(e) << 4; }
};
static_assert(sizeof(Triangle) == 32);

struct Mesh {
  static constexpr std::uint32_t kMaxTriangles = (1u << 30) - 1;  // half-edges have 32 bits

  VirtualArray<Triangle> triangles;
  VirtualArray<Point> vertices;
  std::uint32_t triangle_count = 0;
  std::uint32_t triangle_capacity = 0;
  std::uint32_t vertex_count = 0;  // at the bottom
  std::uint32_t vertex_capacity = 0;
  // Index into Domain::subsegments of vertex vertex_capacity - 1 - k, for each k.
  std::vector<std::uint32_t> subsegments;

  // The domain's triangulation, with room for `max_triangles` in all. `expected_triangles` decides
  // whether huge pages are worth it. Errors: kBudgetExceeded, kLimitExceeded, kCancelled,
  // kDeadlineExceeded.
  static Result<Mesh> from(const Domain& domain, std::uint64_t max_triangles,
                           double expected_triangles, const ExecutionContext& context);

  std::uint32_t add_vertex(Point p) {
    vertices[vertex_count] = p;
    return vertex_count++;
  }
  std::uint32_t add_segment_vertex(Point p, std::uint32_t subsegment) {
    subsegments.push_back(subsegment);
    const auto v = static_cast<std::uint32_t>(vertex_capacity - subsegments.size());
    vertices[v] = p;
    return v;
  }
  // The subsegment that refinement put this vertex on, or kNone.
  std::uint32_t subsegment_of(std::uint32_t vertex) const {
    const std::size_t from_top = vertex_capacity - 1 - vertex;
    return from_top < subsegments.size() ? subsegments[from_top] : kNone;
  }

  std::uint32_t total_vertices() const {
    return vertex_count + static_cast<std::uint32_t>(subsegments.size());
  }
  // The vertices in one row without the gap: 0 to total_vertices() - 1.
  std::uint32_t dense_index(std::uint32_t vertex) const {
    return vertex < vertex_count ? vertex : vertex_count + (vertex_capacity - 1 - vertex);
  }

  std::uint64_t bytes() const {
    return std::uint64_t{triangle_count} * sizeof(Triangle) +
           std::uint64_t{total_vertices()} * sizeof(Point) +
           subsegments.capacity() * sizeof(subsegments[0]);
  }
};

}  // namespace weft

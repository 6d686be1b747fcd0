// SPDX-License-Identifier: Apache-2.0
// The mesh that refinement works on: 32 bytes per triangle and 16 per vertex, so 40 bytes per
// triangle in all.
//
// Triangles are counter-clockwise; edge i is opposite vertex[i], from vertex[i+1] to vertex[i+2].
// A half-edge names a triangle and one of its edges in one word.
//
// Slots come in blocks, and a block has one owner: the task that took it (slots.h). Only the owner
// writes triangles into its slots. It reuses the slots of a cavity for the triangles that
// replace it; another owner's slot in the cavity is only marked dead. So the slots of a task are
// final once no task can reach into its region, and a slot's first vertex shows whether the
// triangle in it is still the same. 3 to 5 % of the slots end dead. Blocks that are no longer
// read are given back and taken again (emit/leaf_release.h), so that a mesh that is sent while
// it is refined takes the memory of a strip of it.
//
// Units: coordinates of the domain. Errors: those of `from`; taking a block throws. Thread-safety:
// blocks may be taken and given back at any time; the rest is governed by ownership.h.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/base/context.h"
#include "engine/base/geometry.h"
#include "engine/domain/domain.h"
#include "engine/refine/storage/block_pool.h"
#include "engine/refine/storage/virtual_array.h"
#include "weft/error.h"

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

// Which bound a triangle misses, and by how much: kGood, kSkinny, or too large from kLarge on, the
// larger the worse. A triangle that is not good has an entry in a queue.
using Badness = std::uint32_t;
inline constexpr Badness kGood = 0;
inline constexpr Badness kSkinny = 1;
inline constexpr Badness kLarge = 2;
inline constexpr Badness kWorst = 255;

// Why refinement refuses to improve a triangle that is bad.
enum class Refusal : std::uint32_t {
  kNone = 0,
  kSmallInputAngle = 1,  // two segments of the input force it
  kEdgeFloor = 2,        // the caller's own floor on edges
  kKept = 3,             // a segment that the caller keeps as it is
  kPrecision = 4,        // the limit of double precision, which the caller did not ask for
};

struct alignas(32) Triangle {
  std::uint32_t vertex[3];
  // Bits 0-2: edge i lies on a segment; 3: dead; 4-6: Refusal; 7: deferred, or refused though too
  // large; 8-15: Badness.
  std::uint32_t flags;
  HalfEdge neighbor[3];
  std::uint32_t region;  // index into Domain::regions

  bool on_segment(std::uint32_t edge) const { return flags >> edge & 1; }
  std::uint32_t segment_bits() const { return flags & 7; }
  bool dead() const { return flags >> 3 & 1; }
  Badness badness() const { return flags >> 8; }
  Refusal refusal() const { return static_cast<Refusal>(flags >> 4 & 7); }
  // Whether a triangle that is bad or refused is larger than its bound.
  bool too_large() const { return badness() >= kLarge || (flags >> 4 & 15) > 8; }
  // Each of these two clears what the other set, except too_large: a refused triangle is no longer
  // to be refined.
  void set_badness(Badness b) { flags = (flags & 7) | b << 8; }
  void set_refusal(Refusal why) {
    const std::uint32_t large = too_large() ? 1u << 7 : 0;
    flags = (flags & 7) | static_cast<std::uint32_t>(why) << 4 | large;
  }
  // Whether the running task has deferred it: the queue may have further entries of it.
  bool deferred() const { return (flags >> 4 & 15) == 8; }
  void set_deferred(bool on) { flags = (flags & ~(1u << 7)) | static_cast<std::uint32_t>(on) << 7; }
  void die() { flags = 1u << 3; }
};
static_assert(sizeof(Triangle) == 32);

struct MeshStore {
  static constexpr std::uint32_t kMaxTriangles = (1u << 30) - 1;  // half-edges have 32 bits
  static constexpr std::uint32_t kTriangleShift = 8;              // 256 triangles per block
  static constexpr std::uint32_t kVertexShift = 7;                // 128 vertices per block
  static constexpr std::uint32_t kTriangleBlock = 1u << kTriangleShift;
  static constexpr std::uint32_t kVertexBlock = 1u << kVertexShift;

  struct VertexBlock {
    std::uint32_t owner;
    std::uint32_t number;      // of its first vertex in the sent mesh
    std::uint32_t on_segment;  // whether `subsegments` has its vertices
  };

  VirtualArray<Triangle> triangles;
  VirtualArray<Point> vertices;
  VirtualArray<std::uint32_t> triangle_owner;  // per block
  VirtualArray<std::uint32_t> triangle_place;  // per block, in the order in which its owner took it
  VirtualArray<VertexBlock> vertex_blocks;
  VirtualArray<std::uint32_t> subsegments;  // per vertex, see subsegment_of
  std::unique_ptr<BlockPool> triangle_pool;
  std::unique_ptr<BlockPool> vertex_pool;

  // Makes a mesh of the domain's triangulation, in blocks of owner 0, with room for at least
  // `max_triangles` in all, and for the slots that tasks leave dead or unused. `expected_triangles`
  // decides whether huge pages are worth it. Errors: kOutOfMemory, kLimitExceeded, kCancelled,
  // kDeadlineExceeded.
  static Result<MeshStore> from(const Domain& domain, std::uint64_t max_triangles,
                                double expected_triangles, const ExecutionContext& context);

  std::uint32_t owner_of_triangle(std::uint32_t t) const {
    return triangle_owner[t >> kTriangleShift];
  }
  // The place of a triangle's slot among its owner's: the same on every run.
  std::uint32_t place_of_triangle(std::uint32_t t) const {
    return triangle_place[t >> kTriangleShift] << kTriangleShift | (t & (kTriangleBlock - 1));
  }
  const VertexBlock& block_of_vertex(std::uint32_t v) const {
    return vertex_blocks[v >> kVertexShift];
  }
  // The subsegment that refinement put this vertex on, or kNone.
  std::uint32_t subsegment_of(std::uint32_t v) const {
    return block_of_vertex(v).on_segment ? subsegments[v] : kNone;
  }
  // The number of a vertex in the sent mesh, once its block has a number.
  std::uint32_t number_of(std::uint32_t v) const {
    return block_of_vertex(v).number + (v & (kVertexBlock - 1));
  }

  // Takes a block, and returns its first slot. Thread-safe. Throws a Failure of kLimitExceeded if
  // all are taken: there are far more than `from` was asked for, or as many as can be numbered.
  // `place`: of the block among its owner's.
  std::uint32_t take_triangle_block(std::uint32_t owner, std::uint32_t place);
  std::uint32_t take_vertex_block(std::uint32_t owner, bool on_segment);
  // Gives back blocks, by their first slots. REQUIRES: nothing reads them any more. Thread-safe.
  void give_back_triangles(const std::vector<std::uint32_t>& first_slots);
  void give_back_vertices(const std::vector<std::uint32_t>& first_slots);

  // Bytes at the peak.
  std::uint64_t bytes() const;
};

}  // namespace weft

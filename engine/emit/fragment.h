// SPDX-License-Identifier: Apache-2.0
// A fragment: some finished vertices and triangles of the mesh as chunks, which are built on any
// thread and sent in the order of the fragments. Coordinates are in units of the domain, angles in
// degrees.
//
// Vertices are numbered by owner, and then in the order in which the owner made them
// (Slots::number_vertices). A triangle goes with the last of its vertices: into the fragment of the
// owner whose number is the highest among them. So a chunk refers only to its own vertices and to
// those of earlier chunks, no two fragments have to agree on anything, and there is no table of
// numbers.
//
// An insertion makes only triangles with a vertex of the slot's owner, so most triangles stay in
// the fragment of their slot's owner. About 2 % have a vertex of a later owner, and are exported to
// its fragment (ExportedTriangle). A triangle of a row (refine/lattice_rows.h) may have vertices of
// earlier owners alone: it stays, too, because its slot's owner is later than these.
//
// Thread-safety: a builder and its fragment belong to one thread at a time. Errors: none; a builder
// returns no fragment if the context stops the run.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "engine/base/context.h"
#include "engine/domain/domain.h"
#include "engine/emit/quality_statistics.h"
#include "engine/refine/acute_corners.h"
#include "engine/refine/storage/mesh_store.h"
#include "engine/refine/storage/slots.h"
#include "weft/error.h"
#include "weft/mesh.h"

namespace weft {

// Chunks without their place in the mesh: Delivery sets `index`, `first_vertex` and
// `first_triangle`.
struct Fragment {
  std::vector<Chunk> chunks;
  QualityStatistics statistics;
  Unrefined unrefined;
  Point unrefined_at;    // as Summary::unrefined_at, of this fragment
  Point kept_at;         // likewise
  double kept_area = 0;  // of that triangle
  std::uint64_t edges = 0;

  std::uint64_t bytes() const;  // of the memory that it points to
};

// A triangle that goes into the fragment of another owner. (A Triangle is aligned to 32 bytes,
// which would make this one 64 bytes long.)
struct ExportedTriangle {
  ExportedTriangle(std::uint32_t owner, std::uint32_t slot, const Triangle& triangle)
      : owner(owner), slot(slot), copy(std::bit_cast<Copy>(triangle)) {}
  Triangle triangle() const { return std::bit_cast<Triangle>(copy); }

  using Copy = std::array<std::uint32_t, sizeof(Triangle) / sizeof(std::uint32_t)>;
  std::uint32_t owner;
  std::uint32_t slot;
  Copy copy;
};

// Returns an owner's triangles that go into later fragments, in the order of its slots. REQUIRES:
// they are final.
std::vector<ExportedTriangle> exported_triangles(const MeshStore& mesh, const Slots& slots);

// Builds one fragment. `AreaBound` gives the bounds for the size histogram: it has bounds_at, as
// ConstantArea and MappedArea do. REQUIRES: all added slots are final, and all vertices of
// triangles have their numbers; `lattice` says whether Steiner points came from one
// (refine/steiner_point.h). A triangle that is still bad counts as `budget` if the budget
// `truncated` refinement; otherwise as `streaming`, because its surroundings had been sent.
template <class AreaBound>
class FragmentBuilder {
 public:
  FragmentBuilder(const MeshStore& mesh, const Domain& domain, const AcuteCorners& corners,
                  AreaBound area, bool lattice, bool truncated, const ExecutionContext& context);

  // Reserves room for about so many: without it, vectors take up to twice what they need.
  void expect(std::size_t vertices, std::size_t triangles);
  // Adds the vertices in slots first <= i < last.
  void add_vertices(std::uint32_t first, std::uint32_t last);
  // Adds the triangles in slots first <= i < last.
  void add_triangles(std::uint32_t first, std::uint32_t last);
  void add_triangle(const Triangle& triangle);

  // Returns nullopt if the context stops the run.
  std::optional<Fragment> finish();

 private:
  void add_bulge(std::uint32_t subsegment, std::uint32_t a, std::uint32_t b);
  void count_unrefined(const Triangle& triangle);
  void make_room(std::size_t bytes);
  void close_chunk();
  void add_block();

  const MeshStore& mesh_;
  const Domain& domain_;
  const AcuteCorners& corners_;
  const bool has_regions_;
  AreaBound area_;
  const bool lattice_;
  const bool truncated_;
  const ExecutionContext& context_;
  bool stopped_ = false;
  Fragment fragment_;
  Chunk chunk_;
  std::size_t bytes_ = 0;  // in chunk_, with those of the block
  // Triangles that are still to be measured and put into chunk_, all at once.
  std::unique_ptr<TriangleBlock> block_ = std::make_unique<TriangleBlock>();
  std::uint32_t numbers_[3 * TriangleBlock::kSize];  // of their vertices
  double region_bound_[TriangleBlock::kSize];
};

}  // namespace weft

// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/emit.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "engine/digest.h"
#include "engine/quality_statistics.h"
#include "engine/refine/area_bound.h"
#include "engine/refine/mapped_area.h"

namespace weft {
namespace {

// What a triangle adds to a chunk at most: itself, its region, three vertices that are input
// points, three edges.
constexpr std::size_t kMaxTriangleBytes = 12 + 4 + 3 * (16 + 8 + sizeof(Chunk::Edge));

// Builds the chunks of a mesh one after the other.
class ChunkBuilder {
 public:
  ChunkBuilder(const Mesh& mesh, const Domain& domain, const AcuteCorners& corners)
      : mesh_(mesh),
        domain_(domain),
        corners_(corners),
        has_regions_(std::any_of(domain.regions.begin(), domain.regions.end(),
                                 [](const Region& r) { return r.id != 0; })),
        number_(mesh.total_vertices(), kNone) {}

  void add(std::uint32_t t) {
    const Triangle& triangle = mesh_.triangles[t];
    for (std::uint32_t v : triangle.vertex) {
      chunk_.triangles.push_back(number(v));
      chunk_.box.add(mesh_.vertices[v]);
    }
    if (has_regions_) chunk_.regions.push_back(domain_.regions[triangle.region].id);
    ++triangles_;
    if (triangle.segment_bits() == 0) [[likely]]
      return;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const HalfEdge across = triangle.neighbor[i];
      if (!triangle.on_segment(i) || (across != kNone && triangle_of(across) < t)) continue;
      const std::uint32_t a = triangle.vertex[kNext[i]];
      const std::uint32_t b = triangle.vertex[kPrevious[i]];
      const Subsegment& s = domain_.subsegments[corners_.subsegment(mesh_, a, b)];
      chunk_.edges.push_back({number(a), number(b), s.segment, s.marker});
      ++edges_;
    }
  }

  bool full() const {
    return chunk_.coordinates.size() * sizeof(double) + chunk_.triangles.size() * 4 +
               chunk_.regions.size() * 4 + chunk_.edges.size() * sizeof(Chunk::Edge) +
               chunk_.input_points.size() * 8 + kMaxTriangleBytes >
           kMaxChunkBytes;
  }
  bool empty() const { return chunk_.triangles.empty(); }

  // The chunk so far; the next one begins.
  Chunk take() {
    const auto is_zero = [](std::int32_t id) { return id == 0; };
    if (std::all_of(chunk_.regions.begin(), chunk_.regions.end(), is_zero)) {
      chunk_.regions.clear();
    }
    chunk_.digest = chunk_digest(chunk_);
    mesh_digest_.add(chunk_.digest.data(), chunk_.digest.size());
    Chunk next;
    next.index = chunk_.index + 1;
    next.first_vertex = vertices_;
    next.first_triangle = triangles_;
    return std::exchange(chunk_, std::move(next));
  }

  void write(Summary& summary) {
    summary.vertices = vertices_;
    summary.triangles = triangles_;
    summary.edges = edges_;
    summary.chunks = chunk_.index;
    summary.digest = mesh_digest_.finish();
  }

  std::uint64_t bytes() const { return number_.size() * sizeof(number_[0]) + kMaxChunkBytes; }

 private:
  // The number of a vertex in the mesh that is sent; its coordinates go with its first use.
  std::uint32_t number(std::uint32_t v) {
    std::uint32_t& number = number_[mesh_.dense_index(v)];
    if (number != kNone) return number;
    chunk_.coordinates.push_back(mesh_.vertices[v].x);
    chunk_.coordinates.push_back(mesh_.vertices[v].y);
    if (v < domain_.vertices.size() && domain_.input_point[v] != kNone) {
      chunk_.input_points.push_back({vertices_, domain_.input_point[v]});
    }
    return number = vertices_++;
  }

  const Mesh& mesh_;
  const Domain& domain_;
  const AcuteCorners& corners_;
  const bool has_regions_;
  std::vector<std::uint32_t> number_;  // by Mesh::dense_index
  Chunk chunk_;
  std::uint32_t vertices_ = 0;
  std::uint32_t triangles_ = 0;
  std::uint64_t edges_ = 0;
  Sha256 mesh_digest_;
};

// The figures of the mesh, gathered in blocks.
template <class AreaBound>
class Figures {
 public:
  Figures(const Mesh& mesh, const std::vector<Region>& regions, AreaBound& area)
      : mesh_(mesh), regions_(regions), area_(area) {}

  void add(std::uint32_t t) {
    const Triangle& triangle = mesh_.triangles[t];
    region_bound_[block_->size] = regions_[triangle.region].max_area;
    block_->add(mesh_.vertices[triangle.vertex[0]], mesh_.vertices[triangle.vertex[1]],
                mesh_.vertices[triangle.vertex[2]]);
    if (block_->size == TriangleBlock::kSize) flush();
    if (triangle.flags <= 7) [[likely]]
      return;
    if (triangle.badness() != Badness::kGood) {
      ++unrefined_.budget;
    } else if (triangle.excuse() == Excuse::kSmallInputAngle) {
      ++unrefined_.small_input_angle;
    } else if (triangle.excuse() == Excuse::kEdgeFloor) {
      ++unrefined_.edge_floor;
    }
  }

  void write(Summary& summary) {
    flush();
    statistics_.write(summary);
    summary.unrefined = unrefined_;
  }

 private:
  void flush() {
    if (block_->size == 0) return;
    block_->find_centroids();
    area_.bounds_at(block_->size, block_->centroid_x, block_->centroid_y, block_->bound);
    for (std::size_t i = 0; i < block_->size; ++i) {
      block_->bound[i] = std::min(block_->bound[i], region_bound_[i]);
    }
    statistics_.add(*block_);
    block_->size = 0;
  }

  const Mesh& mesh_;
  const std::vector<Region>& regions_;
  AreaBound& area_;
  std::unique_ptr<TriangleBlock> block_ = std::make_unique<TriangleBlock>();
  double region_bound_[TriangleBlock::kSize];
  QualityStatistics statistics_;
  Unrefined unrefined_;
};

}  // namespace

template <class AreaBound>
Result<Emitted> emit(const Mesh& mesh, const Domain& domain, const AcuteCorners& corners,
                     AreaBound& area, ChunkSink& sink, ExecutionContext& context,
                     Summary& summary) {
  using Clock = ExecutionContext::Clock;
  Emitted emitted;
  ChunkBuilder chunks(mesh, domain, corners);
  Figures<AreaBound> figures(mesh, domain.regions, area);
  const auto send = [&]() -> std::optional<Error> {
    Chunk chunk = chunks.take();
    const auto start = Clock::now();
    const bool accepted = sink.accept(std::move(chunk));
    emitted.sink_seconds += std::chrono::duration<double>(Clock::now() - start).count();
    if (accepted) return std::nullopt;
    if (auto error = context.poll()) return error;
    return Error{ErrorCode::kCancelled, "", "nobody takes the mesh any more"};
  };
  for (std::uint32_t t = 0; t < mesh.triangle_count; ++t) {
    if (t % TriangleBlock::kSize == 0) {
      if (auto error = context.poll()) return tl::unexpected(*error);
    }
    if (chunks.full()) {
      if (auto error = send()) return tl::unexpected(*error);
    }
    chunks.add(t);
    figures.add(t);
  }
  if (!chunks.empty()) {
    if (auto error = send()) return tl::unexpected(*error);
  }
  chunks.write(summary);
  figures.write(summary);
  emitted.peak_bytes = chunks.bytes() + sizeof(TriangleBlock);
  return emitted;
}

template Result<Emitted> emit(const Mesh&, const Domain&, const AcuteCorners&, ConstantArea&,
                              ChunkSink&, ExecutionContext&, Summary&);
template Result<Emitted> emit(const Mesh&, const Domain&, const AcuteCorners&, MappedArea&,
                              ChunkSink&, ExecutionContext&, Summary&);

}  // namespace weft

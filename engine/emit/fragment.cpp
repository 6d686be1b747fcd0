// SPDX-License-Identifier: Apache-2.0
#include "engine/emit/fragment.h"

#include <algorithm>
#include <utility>

#include "engine/base/vector.h"
#include "engine/domain/arcs/arc.h"
#include "engine/refine/area_bound.h"
#include "engine/refine/mapped_area.h"

namespace weft {
namespace {

// The most that a vertex and a triangle add to a chunk: the vertex as an input point, the triangle
// with its region and three edges and their bulges.
constexpr std::size_t kMaxVertexBytes = 16 + 8;
constexpr std::size_t kMaxTriangleBytes = 12 + 4 + 3 * (sizeof(Chunk::Edge) + sizeof(double));

// An edge between two triangles is written with the triangle in which it leads from its lesser end.
bool leads_upward(Point a, Point b) {
  return a.x < b.x || (a.x == b.x && a.y < b.y);
}

}  // namespace

std::uint64_t Fragment::bytes() const {
  std::uint64_t bytes = 0;
  for (const Chunk& chunk : chunks) {
    bytes += chunk.coordinates.capacity() * sizeof(double) + chunk.triangles.capacity() * 4 +
             chunk.regions.capacity() * 4 + chunk.edges.capacity() * sizeof(Chunk::Edge) +
             chunk.bulges.capacity() * sizeof(double) + chunk.input_points.capacity() * 8;
  }
  return bytes;
}

std::vector<ExportedTriangle> exported_triangles(const MeshStore& mesh, const Slots& slots) {
  std::vector<ExportedTriangle> result;
  slots.for_triangles([&](std::uint32_t first, std::uint32_t last) {
    for (std::uint32_t t = first; t < last; ++t) {
      const Triangle& triangle = mesh.triangles[t];
      if (triangle.dead()) continue;
      const std::uint32_t owner = std::max({mesh.block_of_vertex(triangle.vertex[0]).owner,
                                            mesh.block_of_vertex(triangle.vertex[1]).owner,
                                            mesh.block_of_vertex(triangle.vertex[2]).owner});
      if (owner > slots.owner()) result.emplace_back(owner, t, triangle);
    }
  });
  return result;
}

template <class AreaBound>
FragmentBuilder<AreaBound>::FragmentBuilder(const MeshStore& mesh, const Domain& domain,
                                            const AcuteCorners& corners, AreaBound area,
                                            bool lattice, bool truncated,
                                            const ExecutionContext& context)
    : mesh_(mesh),
      domain_(domain),
      corners_(corners),
      has_regions_(std::any_of(domain.regions.begin(), domain.regions.end(),
                               [](const Region& r) { return r.id != 0; })),
      area_(std::move(area)),
      lattice_(lattice),
      truncated_(truncated),
      context_(context) {}

template <class AreaBound>
void FragmentBuilder<AreaBound>::expect(std::size_t vertices, std::size_t triangles) {
  chunk_.coordinates.reserve(std::min(2 * vertices, kMaxChunkBytes / sizeof(double)));
  chunk_.triangles.reserve(std::min(3 * triangles, kMaxChunkBytes / sizeof(std::uint32_t)));
}

template <class AreaBound>
void FragmentBuilder<AreaBound>::add_vertices(std::uint32_t first, std::uint32_t last) {
  stopped_ = stopped_ || context_.poll();
  for (std::uint32_t v = first; v < last && !stopped_; ++v) {
    make_room(kMaxVertexBytes);
    bytes_ += 16;
    chunk_.coordinates.push_back(mesh_.vertices[v].x);
    chunk_.coordinates.push_back(mesh_.vertices[v].y);
    if (v < domain_.vertices.size() && domain_.input_point[v] != kNone) {
      chunk_.input_points.push_back({mesh_.number_of(v), domain_.input_point[v]});
      bytes_ += 8;
    }
  }
}

template <class AreaBound>
void FragmentBuilder<AreaBound>::add_triangles(std::uint32_t first, std::uint32_t last) {
  for (std::uint32_t t = first; t < last && !stopped_; ++t) {
    if (!mesh_.triangles[t].dead()) add_triangle(mesh_.triangles[t]);
  }
}

template <class AreaBound>
void FragmentBuilder<AreaBound>::add_triangle(const Triangle& triangle) {
  if (block_->size == TriangleBlock::kSize) add_block();
  make_room(kMaxTriangleBytes);
  bytes_ += has_regions_ ? 16 : 12;
  const Region& region = domain_.regions[triangle.region];
  const auto& v = triangle.vertex;
  for (std::size_t i = 0; i < 3; ++i) numbers_[3 * block_->size + i] = mesh_.number_of(v[i]);
  region_bound_[block_->size] = region.max_area;
  block_->add(mesh_.vertices[v[0]], mesh_.vertices[v[1]], mesh_.vertices[v[2]]);
  if (has_regions_) chunk_.regions.push_back(region.id);
  const bool good = triangle.flags <= 7;  // neither bad nor refused
  if (!good) [[unlikely]]
    count_unrefined(triangle);
  if (triangle.segment_bits() == 0) [[likely]]
    return;
  for (std::uint32_t i = 0; i < 3; ++i) {
    if (!triangle.on_segment(i)) continue;
    const std::uint32_t a = triangle.vertex[kNext[i]];
    const std::uint32_t b = triangle.vertex[kPrevious[i]];
    if (triangle.neighbor[i] != kNone && !leads_upward(mesh_.vertices[a], mesh_.vertices[b]))
      continue;
    const std::uint32_t subsegment = corners_.subsegment(mesh_, a, b);
    const Subsegment& s = domain_.subsegments[subsegment];
    chunk_.edges.push_back({mesh_.number_of(a), mesh_.number_of(b), s.segment, s.marker});
    bytes_ += sizeof(Chunk::Edge);
    ++fragment_.edges;
    if (corners_.has_arcs()) add_bulge(subsegment, a, b);
  }
}

template <class AreaBound>
void FragmentBuilder<AreaBound>::add_bulge(std::uint32_t subsegment, std::uint32_t a,
                                           std::uint32_t b) {
  const Subsegment& s = domain_.subsegments[subsegment];
  const Vector chord = mesh_.vertices[b] - mesh_.vertices[a];
  const bool forward = dot(chord, domain_.vertices[s.b] - domain_.vertices[s.a]) > 0;
  const double bulge = bulge_of(corners_.curvature(subsegment), length(chord));
  chunk_.bulges.push_back(forward ? bulge : -bulge);
  bytes_ += sizeof(double);
}

template <class AreaBound>
void FragmentBuilder<AreaBound>::count_unrefined(const Triangle& triangle) {
  Unrefined& count = fragment_.unrefined;
  const Point a = mesh_.vertices[triangle.vertex[0]];
  const Point b = mesh_.vertices[triangle.vertex[1]];
  const Point c = mesh_.vertices[triangle.vertex[2]];
  const bool left = triangle.badness() != kGood;
  if (left && truncated_) {
    ++count.budget;
  } else if (triangle.refusal() == Refusal::kSmallInputAngle) {
    ++count.small_input_angle;
  } else if (triangle.refusal() == Refusal::kEdgeFloor) {
    ++count.edge_floor;
  } else if (triangle.refusal() == Refusal::kKept) {
    ++count.kept;
    const double area = 0.5 * cross(b - a, c - a);
    if (area > fragment_.kept_area) {
      fragment_.kept_area = area;
      fragment_.kept_at = centroid(a, b, c);
    }
  } else {
    if (count.without_exemption() == 0) fragment_.unrefined_at = centroid(a, b, c);
    ++(left ? count.streaming : count.precision);
    count.too_large += triangle.too_large();
  }
}

template <class AreaBound>
std::optional<Fragment> FragmentBuilder<AreaBound>::finish() {
  if (stopped_) return std::nullopt;
  if (bytes_ > 0) close_chunk();
  return std::move(fragment_);
}

template <class AreaBound>
void FragmentBuilder<AreaBound>::make_room(std::size_t bytes) {
  if (bytes_ + bytes > kMaxChunkBytes) [[unlikely]]
    close_chunk();
}

template <class AreaBound>
void FragmentBuilder<AreaBound>::close_chunk() {
  add_block();
  const auto is_zero = [](auto value) { return value == 0; };
  if (std::all_of(chunk_.regions.begin(), chunk_.regions.end(), is_zero)) chunk_.regions.clear();
  if (std::all_of(chunk_.bulges.begin(), chunk_.bulges.end(), is_zero)) chunk_.bulges.clear();
  chunk_.digest = chunk_digest(chunk_);
  fragment_.chunks.push_back(std::exchange(chunk_, Chunk{}));
  bytes_ = 0;
}

template <class AreaBound>
void FragmentBuilder<AreaBound>::add_block() {
  stopped_ = stopped_ || context_.poll();
  const std::size_t n = block_->size;
  if (n == 0) return;
  chunk_.triangles.insert(chunk_.triangles.end(), numbers_, numbers_ + 3 * n);
  chunk_.box.merge(block_->box());
  block_->find_centroids();
  area_.bounds_at(n, block_->centroid_x, block_->centroid_y, block_->bound);
  for (std::size_t i = 0; i < n; ++i) {
    block_->bound[i] = std::min(block_->bound[i], region_bound_[i]);
    block_->on_lattice[i] =
        lattice_ && area_.on_lattice({block_->centroid_x[i], block_->centroid_y[i]},
                                     block_->bound[i], region_bound_[i]);
  }
  fragment_.statistics.add(*block_);
  block_->size = 0;
}

template class FragmentBuilder<ConstantArea>;
template class FragmentBuilder<MappedArea>;

}  // namespace weft

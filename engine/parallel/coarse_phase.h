// SPDX-License-Identifier: Apache-2.0
// The phase before the leaves' tasks: makes a coarse mesh, the quadtree from it and the order of
// its leaves, circumradii that fit them (the paper's eq. 5), and the list of bad triangles to begin
// with.
//
//   CoarsePhase<ConstantArea> coarse_phase(refinement, quality, area, narrow_places, 16'000, 1,
//                                          slots);
//   Result<Quadtree> tree = coarse_phase.find_tree(box);
//   if (!tree) return tree.error();
//   if (auto error = coarse_phase.fit(*tree, box)) return error;
//   LeafOrder order = coarse_phase.take_order();
//
// The coarse mesh obeys a multiple of the grading function, and no bound on angles. So it follows
// the grading everywhere in the domain, and misses none of its features. It does not show the
// triangles that the bound on angles will make at narrow places: these add samples of their own.
//
// If there are many leaves, the coarse mesh is coarser still, and its triangles are cut into pieces
// that obey the same bound, which serve only as samples. Then it is refined block by block
// (coarse_blocks.h).
//
// Errors: those of refinement (refine/refiner.h). Not thread-safe; it uses the context's threads.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/context.h"
#include "engine/parallel/leaf_order.h"
#include "engine/parallel/leaf_radius.h"
#include "engine/parallel/narrow_places.h"
#include "engine/parallel/quadtree.h"
#include "engine/refine/refiner.h"
#include "engine/refine/storage/slots.h"
#include "engine/refine/triangle_block.h"
#include "engine/refine/triangle_judge.h"

namespace weft {

template <class AreaBound>
class CoarsePhase {
 public:
  // `slots` has all triangles of the mesh, and takes new ones. Each triangle of the coarse mesh is
  // cut into about `pieces` pieces.
  CoarsePhase(const RefinementContext& refinement, const QualityBounds& quality,
              const AreaBound& area, const NarrowPlaces& narrow, double leaf_triangles,
              double pieces, Slots& slots)
      : refinement_(refinement),
        quality_(quality),
        area_(area),
        narrow_(narrow),
        leaf_triangles_(leaf_triangles),
        pieces_(pieces),
        slots_(slots) {
    no_angles_.sin2 = 0;
    no_angles_.off_centre = 0;
  }

  // `box` holds the domain.
  Result<Quadtree> find_tree(const Box& box) {
    if (auto error = refine(area_.again(pieces_ * coarseness()), box))
      return tl::unexpected(*error);
    refinement_.context.end_stage("coarse mesh");
    std::vector<Quadtree::Sample> all = samples();
    if (auto error = refinement_.context.poll()) return tl::unexpected(*error);
    const std::uint64_t held = refinement_.other_bytes + refinement_.mesh.bytes() +
                               all.capacity() * sizeof(Quadtree::Sample);
    auto tree = Quadtree::build(box, std::move(all), leaf_triangles_, [&](std::uint64_t leaves) {
      return refinement_.context.need_bytes(held + leaves * kBytesPerLeaf, "the mesh");
    });
    refinement_.context.end_stage("quadtree");
    if (auto error = refinement_.context.poll()) return tl::unexpected(*error);
    return tree;
  }

  // Fits the circumradii, orders the leaves, and finds the bad triangles, if there is more than one
  // leaf.
  std::optional<Error> fit(const Quadtree& tree, const Box& box) {
    std::optional<Error> error;
    const LeafRadius<AreaBound> radius(tree, min_dense_weight(tree), area_, refinement_.context);
    // These two are independent.
    refinement_.context.for_each(2, [&](std::size_t which) {
      if (which == 0) error = refine(radius, box);
      if (which == 1) order_ = order_of(tree, area_);
    });
    refinement_.context.end_stage("leaf radius");
    if (error) return error;
    error = judge(tree, box);
    refinement_.context.end_stage("seeding");
    return error;
  }

  // The order of a tree's leaves: rows may fill those where the size is one value.
  static LeafOrder order_of(const Quadtree& tree, const AreaBound& area) {
    return LeafOrder(
        tree, [&](const Quadtree::Leaf& leaf) { return area.uniform_bound(leaf.box).has_value(); });
  }

  // Whether the criterion of the circumradius applies to all leaves.
  bool all_dense(const Quadtree& tree) const { return min_dense_weight(tree) == 0; }

  LeafOrder take_order() { return std::move(order_); }
  // In the order of the slots.
  const std::vector<BadTriangle>& bad_triangles() const { return bad_; }
  // Whether every circumradius is below a quarter of its leaf's side, even in leaves that are not
  // dense: then the clean-up stays near.
  bool fits() const { return fits_; }
  const RefinerStats& stats() const { return stats_; }

 private:
  // The number of coarse triangles per leaf: a dozen are needed to place the leaves' borders well.
  static constexpr double kCoarseTrianglesPerLeaf = 16;
  // What a leaf takes before any of its triangles are made: in the tree and while it is sorted, in
  // the order, and in the graph of tasks while it is built.
  static constexpr std::uint64_t kBytesPerLeaf = 2000;
  // A leaf is dense if it expects one in kDense of the triangles that it has room for: a bound on
  // the circumradius adds few to these.
  static constexpr double kDense = 16;

  using Run = std::pair<std::uint32_t, std::uint32_t>;  // of slots: first, and one past the last

  // What one thread found in some of the slots.
  struct Found {
    std::vector<BadTriangle> bad;
    bool fits = true;
    std::optional<BadSize> bad_size;
  };

  double coarseness() const { return leaf_triangles_ / kCoarseTrianglesPerLeaf; }
  double min_dense_weight(const Quadtree& tree) const {
    return dense_weight(tree, leaf_triangles_ / kDense);
  }

  template <class Area>
  std::optional<Error> refine(const Area& area, const Box& box) {
    Refiner<OwnsAll, Area> refiner(refinement_, no_angles_, area);
    refiner.begin(slots_, OwnsAll{}, box);
    auto error = refiner.queue_all();
    if (!error) error = refiner.run();
    stats_ += refiner.stats();
    return error;
  }

  std::vector<Run> runs() const {
    std::vector<Run> result;
    constexpr std::uint32_t kMax = 32;  // slots: with pieces, each has many samples
    slots_.for_triangles([&](std::uint32_t first, std::uint32_t last) {
      for (; last - first > kMax; first += kMax) result.push_back({first, first + kMax});
      result.push_back({first, last});
    });
    return result;
  }

  // The coarse triangles, or their pieces, each with its estimate of final triangles.
  std::vector<Quadtree::Sample> samples() const {
    const std::vector<Run> all = runs();
    std::vector<std::vector<Quadtree::Sample>> found(all.size());
    refinement_.context.for_each(all.size(), [&](std::size_t r) {
      if (!refinement_.context.poll()) found[r] = samples(all[r]);
    });
    std::vector<Quadtree::Sample> result;
    for (const auto& samples : found) result.insert(result.end(), samples.begin(), samples.end());
    narrow_.add_samples(coarseness(), result);
    return result;
  }

  // Triangles that are measured together.
  struct Block {
    TriangleBlock triangles;
    double by_region[TriangleBlock::kSize];
  };
  struct Piece {
    std::array<Point, 3> corners;
    double most;  // pieces of it
  };

  std::vector<Quadtree::Sample> samples(const Run& run) const {
    const MeshStore& mesh = refinement_.mesh;
    std::vector<Quadtree::Sample> result;
    Block block;
    AreaBound area = area_.again();
    AreaBound coarse = area_.again(coarseness());
    TriangleJudge judge;
    std::vector<Piece> pieces;
    for (std::uint32_t t = run.first; t < run.second; ++t) {
      const auto& v = mesh.triangles[t].vertex;
      if (pieces_ > 1 && refinement_.context.poll()) return result;
      pieces.push_back(
          {{mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]}, most_pieces()});
      if (pieces_ > 1) coarse.begin(box_of(pieces.back().corners));
      while (!pieces.empty()) {
        const Piece piece = pieces.back();
        pieces.pop_back();
        const auto& [p, q, r] = piece.corners;
        if (piece.most > 1 && doubled_area(p, q, r) > 2 * coarseness() * least_area() &&
            judge(p, q, r, region_bound(t), no_angles_, coarse) != kGood) {
          cut(piece, pieces);
          continue;
        }
        block.by_region[block.triangles.size] = region_bound(t);
        block.triangles.add(p, q, r);
        if (block.triangles.size == TriangleBlock::kSize) add_samples(block, area, result);
      }
    }
    if (block.triangles.size > 0) add_samples(block, area, result);
    return result;
  }

  // The maximum of pieces per triangle, so that cutting ends however small the size is.
  double most_pieces() const {
    constexpr double kUnevenness = 64;  // of the size in a triangle of the coarse mesh
    return pieces_ > 1 ? kUnevenness * pieces_ : 1;
  }

  static double doubled_area(Point a, Point b, Point c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  }
  // The least area of a triangle, by the floor on its edges.
  double least_area() const { return kEquilateral * quality_.min_length2; }

  static Box box_of(const std::array<Point, 3>& triangle) {
    Box box;
    for (const Point p : triangle) box.add(p);
    return box;
  }

  // Cuts a piece in two at the middle of its longest edge.
  static void cut(const Piece& piece, std::vector<Piece>& pieces) {
    const auto& t = piece.corners;
    std::size_t longest = 0;
    const auto length2 = [&](std::size_t i) { return distance2(t[i], t[kNext[i]]); };
    for (std::size_t i = 1; i < 3; ++i) {
      if (length2(i) > length2(longest)) longest = i;
    }
    const Point a = t[longest];
    const Point b = t[kNext[longest]];
    const Point apex = t[kPrevious[longest]];
    const Point middle{a.x + 0.5 * (b.x - a.x), a.y + 0.5 * (b.y - a.y)};
    pieces.push_back({{a, middle, apex}, 0.5 * piece.most});
    pieces.push_back({{middle, b, apex}, 0.5 * piece.most});
  }

  // Adds the samples of a block, and empties the block.
  void add_samples(Block& all, AreaBound& area, std::vector<Quadtree::Sample>& result) const {
    TriangleBlock& block = all.triangles;
    block.find_centroids();
    area.bounds_at(block.size, block.centroid_x, block.centroid_y, block.bound);
    for (std::size_t i = 0; i < block.size; ++i) {
      const double size =
          0.5 * doubled_area({block.x[0][i], block.y[0][i]}, {block.x[1][i], block.y[1][i]},
                             {block.x[2][i], block.y[2][i]});
      const Point at{block.centroid_x[i], block.centroid_y[i]};
      const double bound = std::min(block.bound[i], all.by_region[i]);
      const double per_bound = triangles_per_bound(
          area.on_lattice(at, bound, all.by_region[i]) ? quality_.lattice : LatticeShape{});
      const double asked = bound > 0 ? size / std::max(bound / per_bound, least_area()) : 1;
      result.push_back({at, std::max(asked, 1.0)});
    }
    block.size = 0;
  }

  // Judges all triangles by the bounds of the final mesh.
  std::optional<Error> judge(const Quadtree& tree, const Box& box) {
    const std::vector<Run> all = runs();
    std::vector<Found> found(all.size());
    refinement_.context.for_each(all.size(),
                                 [&](std::size_t r) { found[r] = judge(all[r], tree, box); });
    for (const Found& f : found) {
      if (f.bad_size) return bad_size_error(*f.bad_size);
      bad_.insert(bad_.end(), f.bad.begin(), f.bad.end());
      fits_ = fits_ && f.fits;
    }
    return refinement_.context.poll();
  }

  Found judge(const Run& run, const Quadtree& tree, const Box& box) const {
    const MeshStore& mesh = refinement_.mesh;
    Found found;
    AreaBound area = area_.again();
    area.begin(box);
    TriangleJudge judge;
    for (std::uint32_t t = run.first; t < run.second; ++t) {
      Triangle& triangle = mesh.triangles[t];
      const Badness badness = judge(mesh, t, region_bound(t), quality_, area);
      triangle.set_badness(badness);
      if (badness != kGood) found.bad.push_back({t, triangle.vertex[0]});
      found.fits = found.fits && fits(triangle, tree);
    }
    found.bad_size = area.bad_size();
    return found;
  }

  bool fits(const Triangle& t, const Quadtree& tree) const {
    const Point a = refinement_.mesh.vertices[t.vertex[0]];
    const Point b = refinement_.mesh.vertices[t.vertex[1]];
    const Point c = refinement_.mesh.vertices[t.vertex[2]];
    const double limit = LeafRadius<AreaBound>::kRadiusPerSide *
                         tree.leaves()[tree.leaf_at(centroid(a, b, c))].side();
    return circumradius2(a, b, c) <= limit * limit;
  }

  double region_bound(std::uint32_t t) const {
    return refinement_.regions[refinement_.mesh.triangles[t].region].max_area;
  }

  const RefinementContext refinement_;
  const QualityBounds quality_;
  QualityBounds no_angles_ = quality_;
  const AreaBound& area_;
  const NarrowPlaces& narrow_;
  const double leaf_triangles_;
  const double pieces_;
  Slots& slots_;
  LeafOrder order_;
  std::vector<BadTriangle> bad_;
  bool fits_ = true;
  RefinerStats stats_;
};

}  // namespace weft

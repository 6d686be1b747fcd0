// SPDX-License-Identifier: Apache-2.0
// What comes before the leaves' tasks: a coarse mesh, the quadtree from it and the order of its
// leaves, circumradii that fit them (the paper's eq. 5), and the bad triangles to begin with.
//
//   Prelude<ConstantArea> prelude(setting, quality, area, narrow_places, 16'000, slots);
//   if (auto error = prelude.run(box)) return error;
//   Quadtree tree = prelude.take_tree();
//   LeafOrder order = prelude.take_order();
//
// The coarse mesh obeys the grading function, multiplied, and no bound on angles. So it follows the
// grading wherever the domain is, and misses none of its features. What the bound on angles will
// make at narrow places is not in it: these add samples of their own.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "engine/context.h"
#include "engine/quality_statistics.h"
#include "engine/refine/refiner.h"
#include "engine/refine/slots.h"
#include "engine/refine/triangle_judge.h"
#include "engine/schedule/leaf_order.h"
#include "engine/schedule/leaf_radius.h"
#include "engine/schedule/narrow_places.h"
#include "engine/schedule/quadtree.h"

namespace weft {

template <class AreaBound>
class Prelude {
 public:
  // `slots` has all triangles of the mesh, and takes those that are made.
  Prelude(const Setting& setting, const QualityBounds& quality, const AreaBound& area,
          const NarrowPlaces& narrow, double leaf_triangles, Slots& slots)
      : setting_(setting),
        quality_(quality),
        area_(area),
        narrow_(narrow),
        leaf_triangles_(leaf_triangles),
        slots_(slots) {}

  // `box` holds the domain. Ends with the coarse mesh where one leaf is enough.
  std::optional<Error> run(const Box& box) {
    QualityBounds no_angles = quality_;
    no_angles.sin2 = 0;
    no_angles.off_centre = 0;
    const double coarseness = leaf_triangles_ / kCoarseTrianglesPerLeaf;
    if (auto error = refine(no_angles, area_.again(coarseness), box)) return error;
    setting_.context.end_stage("coarse mesh");
    tree_ = Quadtree::build(box, samples(), leaf_triangles_);
    setting_.context.end_stage("quadtree");
    if (tree_.leaves().size() == 1) return std::nullopt;
    // Neither needs the other.
    std::optional<Error> error;
    const LeafRadius<AreaBound> radius(tree_, busy_weight(tree_, leaf_triangles_ / kBusy), area_);
    setting_.context.for_each(2, [&](std::size_t which) {
      if (which == 0) error = refine(no_angles, radius, box);
      if (which == 1) order_ = LeafOrder(tree_);
    });
    setting_.context.end_stage("leaf radius");
    if (error) return error;
    error = judge(box);
    setting_.context.end_stage("seeding");
    return error;
  }

  Quadtree take_tree() { return std::move(tree_); }
  // Where the tree has more than one leaf.
  LeafOrder take_order() { return std::move(order_); }
  // In the order of the slots.
  const std::vector<BadTriangle>& bad_triangles() const { return bad_; }
  // Whether every circumradius is below a quarter of its leaf's side, in leaves that are not busy
  // too: then what is cleaned up stays near.
  bool fits() const { return fits_; }
  const RefinerFigures& figures() const { return figures_; }

 private:
  // A coarse triangle stands for one in so many of a leaf: it takes a dozen of them to place the
  // leaves' borders well.
  static constexpr double kCoarseTrianglesPerLeaf = 16;
  // A leaf is busy with one in so many of the triangles that it has room for: those that a bound on
  // the circumradius makes are few among them.
  static constexpr double kBusy = 16;

  using Run = std::pair<std::uint32_t, std::uint32_t>;  // of slots: first, and one past the last

  // What one thread found in some of the slots.
  struct Found {
    std::vector<BadTriangle> bad;
    bool fits = true;
    std::optional<BadSize> bad_size;
  };

  template <class Area>
  std::optional<Error> refine(const QualityBounds& quality, const Area& area, const Box& box) {
    Refiner<OwnsAll, Area> refiner(setting_, quality, area);
    refiner.begin(slots_, OwnsAll{}, box);
    auto error = refiner.queue_all();
    if (!error) error = refiner.run();
    figures_ += refiner.figures();
    return error;
  }

  std::vector<Run> runs() const {
    std::vector<Run> result;
    slots_.for_triangles([&](std::uint32_t first, std::uint32_t last) {
      result.push_back({first, last});
    });
    return result;
  }

  // The coarse triangles, each with the number that it will be split into.
  std::vector<Quadtree::Sample> samples() const {
    const std::vector<Run> all = runs();
    std::vector<std::vector<Quadtree::Sample>> found(all.size());
    setting_.context.for_each(all.size(), [&](std::size_t r) { found[r] = samples(all[r]); });
    std::vector<Quadtree::Sample> result;
    for (const auto& samples : found) result.insert(result.end(), samples.begin(), samples.end());
    narrow_.add_samples(leaf_triangles_ / kCoarseTrianglesPerLeaf, result);
    return result;
  }

  std::vector<Quadtree::Sample> samples(const Run& run) const {
    // Triangles are no smaller than the floor on their edges allows.
    const double floor = kEquilateral * quality_.min_length2;
    static_assert(Mesh::kTriangleBlock <= TriangleBlock::kSize);
    const Mesh& mesh = setting_.mesh;
    TriangleBlock block;
    for (std::uint32_t t = run.first; t < run.second; ++t) {
      const auto& v = mesh.triangles[t].vertex;
      block.add(mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]);
    }
    block.find_centroids();
    AreaBound area = area_.again();
    area.bounds_at(block.size, block.centroid_x, block.centroid_y, block.bound);
    std::vector<Quadtree::Sample> result;
    for (std::size_t i = 0; i < block.size; ++i) {
      const double size = 0.5 * ((block.x[1][i] - block.x[0][i]) * (block.y[2][i] - block.y[0][i]) -
                                 (block.y[1][i] - block.y[0][i]) * (block.x[2][i] - block.x[0][i]));
      const Point at{block.centroid_x[i], block.centroid_y[i]};
      const double by_region = region_bound(run.first + static_cast<std::uint32_t>(i));
      const double bound = std::min(block.bound[i], by_region);
      const double per_bound = triangles_per_bound(
          area.on_lattice(at, bound, by_region) ? quality_.lattice : LatticeShape{});
      const double asked = bound > 0 ? size / std::max(bound / per_bound, floor) : 1;
      result.push_back({at, std::max(asked, 1.0)});
    }
    return result;
  }

  // Judges all triangles by the bounds of the mesh that is asked for.
  std::optional<Error> judge(const Box& box) {
    const std::vector<Run> all = runs();
    std::vector<Found> found(all.size());
    setting_.context.for_each(all.size(), [&](std::size_t r) { found[r] = judge(all[r], box); });
    for (const Found& f : found) {
      if (f.bad_size) return bad_size_error(*f.bad_size);
      bad_.insert(bad_.end(), f.bad.begin(), f.bad.end());
      fits_ = fits_ && f.fits;
    }
    return setting_.context.poll();
  }

  Found judge(const Run& run, const Box& box) const {
    const Mesh& mesh = setting_.mesh;
    Found found;
    AreaBound area = area_.again();
    area.begin(box);
    TriangleJudge judge;
    for (std::uint32_t t = run.first; t < run.second; ++t) {
      Triangle& triangle = mesh.triangles[t];
      const Badness badness = judge(mesh, t, region_bound(t), quality_, area);
      triangle.set_badness(badness);
      if (badness != kGood) found.bad.push_back({t, triangle.vertex[0]});
      found.fits = found.fits && fits(triangle);
    }
    found.bad_size = area.bad_size();
    return found;
  }

  bool fits(const Triangle& t) const {
    const Point a = setting_.mesh.vertices[t.vertex[0]];
    const Point b = setting_.mesh.vertices[t.vertex[1]];
    const Point c = setting_.mesh.vertices[t.vertex[2]];
    const double limit =
        LeafRadius<AreaBound>::kPart * tree_.leaves()[tree_.leaf_at(centroid(a, b, c))].side();
    return circumradius2(a, b, c) <= limit * limit;
  }

  double region_bound(std::uint32_t t) const {
    return setting_.regions[setting_.mesh.triangles[t].region].max_area;
  }

  const Setting setting_;
  const QualityBounds quality_;
  const AreaBound& area_;
  const NarrowPlaces& narrow_;
  const double leaf_triangles_;
  Slots& slots_;
  Quadtree tree_;
  LeafOrder order_;
  std::vector<BadTriangle> bad_;
  bool fits_ = true;
  RefinerFigures figures_;
};

}  // namespace weft

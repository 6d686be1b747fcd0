// SPDX-License-Identifier: Apache-2.0
// A grading function that varies: evaluated for a ring of triangles at a time,
// and only if the size map's bounds do not decide (size/size_map.h).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "engine/refine/area_bound.h"
#include "engine/size/lattice/lattice.h"
#include "engine/size/lattice/lattice_map.h"
#include "engine/size/size_map.h"

namespace weft {

// Used by one task at a time. `begin` lays a grid over the task's box; once a ring needed a cell,
// the cell knows whether the function is constant in it and the cells around it. Most rings lie in
// the constant box of the last one, most others in such a cell (bench/README.md).
class MappedArea {
 public:
  static constexpr bool kBoundsAreas = true;

  // Bounds are multiplied by `coarseness`.
  MappedArea(const SizeFunction& function, const SizeMap& map, const LatticeMap& lattices,
             double coarseness = 1)
      : function_(function),
        map_(map),
        lattices_(lattices),
        lattice_cell_(&lattices.cells().front()),
        coarseness_(coarseness) {}

  // A copy for another thread or another coarseness.
  MappedArea again(double coarseness = 1) const { return {function_, map_, lattices_, coarseness}; }

  // Begins a task most of whose rings lie in `box`. Bounds have no slack.
  void begin(const Box& box);

  // From now on, bounds are multiplied by `slack`, but for places where a lattice follows the size,
  // or where the size jumps.
  void set_slack(double slack) { slack_ = slack; }
  // Whether there may be such a slack somewhere in the box.
  bool has_slack_in(const Box& box, const LatticeShape&) const {
    return !lattices_.is_faultless_in(box);
  }
  // Whether a lattice follows the size at p, so that there is no slack.
  bool fits_lattice(Point p) {
    find_lattice_cell(p);
    return lattice_cell_->faultless();
  }
  // Whether one of the region's own bound does, where `bound` is the lesser of both.
  static constexpr bool fits_region(double bound, double region_bound) {
    return region_bound <= bound;
  }

  RingVerdict judge(const Ring& ring, std::uint32_t first, std::uint32_t last, Point p,
                    double region_bound, const QualityBounds& quality, Badness* badness) {
    if (const double room = room_in(box_, p); room > 0) [[likely]] {
      const RingVerdict verdict =
          judge_ring(ring, first, last, quality, uniform(p, region_bound), badness);
      if (verdict.farthest2 <= room * room) [[likely]]
        return verdict;
    }
    return judge_by_cell(ring, first, last, p, region_bound, quality, badness);
  }

  // The lattice point nearest to c. The lattice is that of the final mesh, whatever the coarseness.
  // A region has its own lattice where its bound is below that of the size's lattice.
  LatticePoint nearest_of_lattice(Point c, double region_bound, const LatticeShape& shape) {
    find_lattice_cell(c);
    if (lattice_cell_->kind == LatticeMap::Kind::kFit) {
      const LatticePoint point = lattice_cell_->map.nearest(c, shape.jitter);
      if (kEquilateral * point.spacing2 <= region_bound) [[likely]]
        return point;
      return lattice_.nearest(c, region_bound, shape);
    }
    double bound = 0;
    if (lattice_cell_->kind == LatticeMap::Kind::kConstant) bound = lattice_cell_->size;
    if (lattice_cell_->kind == LatticeMap::Kind::kStepped) bound = bound_of_piece(c);
    if (bound == 0 && region_bound < kNoBound && region_bound <= function_(c)) bound = region_bound;
    return lattice_.nearest(c, std::min(bound, region_bound), shape);
  }

  // The bound if it is one value in all of the box, as far as the map tells.
  std::optional<double> uniform_bound(const Box& box) const { return map_.uniform_size(box); }

  // Whether there is a lattice at p. `bound` is the bound there, that of the region included.
  bool on_lattice(Point p, double bound, double region_bound) {
    find_lattice_cell(p);
    return lattice_cell_->kind == LatticeMap::Kind::kFit ||
           lattice_cell_->kind == LatticeMap::Kind::kConstant || region_bound <= bound;
  }

  // Insertions between polls: fewer if the function is costly (4,096 powers take 1 ms per ring).
  std::uint32_t poll_interval() const {
    return 1 + static_cast<std::uint32_t>(512 / (1 + function_.operations() / 16));
  }

  // Whether a triangle of this area overlaps a place where the function is far less for certain, so
  // that it is bad, whatever the bound at its centroid; as far as the cell of a tells.
  bool covers_finer(Point a, Point b, Point c, double area);

  // The grading function at n points. REQUIRES: as SizeFunction::evaluate.
  void bounds_at(std::size_t n, const double* x, const double* y, double* bound);

  const std::optional<BadSize>& bad_size() const { return bad_size_; }

 private:
  static constexpr std::size_t kGrid = 16;  // cells each way
  static constexpr double kNoBound = std::numeric_limits<double>::infinity();

  // The vectors that hold a function's batches.
  struct alignas(64) Lanes {
    double values[SizeFunction::kLanes];
  };

  // A cell and those around it.
  struct Cell {
    bool known = false;
    double size = 0;  // the function's value if it is constant; otherwise 0
    Box around;
    SizeMap::Place place{};
  };
  Cell& cell_at(Point p);

  void find_lattice_cell(Point p) {
    if (!(room_in(lattice_cell_->box, p) > 0)) [[unlikely]]
      lattice_cell_ = &lattices_.locate(p);
  }
  // At the border of constant pieces: the bound at c if it is the same an edge's length away, in x
  // and in y, on at least one side; otherwise 0.
  double bound_of_piece(Point c) const;
  UniformAreaBound uniform(Point p, double region_bound) {
    return {2 * slack_at(p, size_, region_bound) * coarseness_ * std::min(size_, region_bound)};
  }
  double slack_at(Point p, double bound, double region_bound) {
    if (slack_ == 1) [[likely]]
      return 1;
    return fits_region(bound, region_bound) || fits_lattice(p) ? 1 : slack_;
  }
  // Judges by the cell of p; looks the ring up in the map if it reaches beyond the cells around.
  RingVerdict judge_by_cell(const Ring& ring, std::uint32_t first, std::uint32_t last, Point p,
                            double region_bound, const QualityBounds& quality, Badness* badness);
  // Evaluates the function at the centroids.
  RingVerdict judge_evaluated(const SizeMap::Place& place, const Ring& ring, std::uint32_t first,
                              std::uint32_t last, Point p, double region_bound,
                              const QualityBounds& quality, Badness* badness);

  const SizeFunction& function_;
  const SizeMap& map_;
  const LatticeMap& lattices_;
  const LatticeMap::Cell* lattice_cell_;  // the last one asked for
  UniformLattice lattice_;
  const double coarseness_;
  double slack_ = 1;
  Box box_;          // where the function is constant; empty at first
  double size_ = 0;  // its value there
  Box grid_;
  double cells_per_x_ = 0;  // cells per unit
  double cells_per_y_ = 0;
  std::array<Cell, kGrid * kGrid> cells_;
  std::vector<Lanes> x_, y_, bound_;
  std::optional<BadSize> bad_size_;
};

}  // namespace weft

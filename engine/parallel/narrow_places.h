// SPDX-License-Identifier: Apache-2.0
// Estimates the triangles that the bound on angles makes where the domain is narrow.
//
//   auto places = NarrowPlaces::find(domain, crossed_arms, quality, expected_area, context);
//   places->expected();                            // triangles beyond those that the size makes
//   places->add_samples(1'000, samples);           // for the quadtree
//
// A triangle between two segments that run side by side is as short as the gap is wide, whatever
// the size allows, and the triangles around grow only slowly (Ruppert's local feature size). So a
// segment at a distance w from what it sees on either side costs a number of triangles in
// proportion to its length over w. Only segments at the base of a thin triangle of the domain can
// be near to others over a long way. These are measured in pieces, which are halved until the
// nearest vertex or segment, seen through the triangles of the domain, is about equally far along
// the whole piece. Vertices near a segment cost a logarithm, and so few pieces. So do two arms of a
// corner, which are left out, also where others cross them (crossed_arms.h).
//
// The number of triangles per unit of length / w depends only on the angle, to a factor of
// 1.5: measured on strips at 5 to 33 degrees (narrow_places.cpp).
//
// The square root is the only C library function: the same bits on every machine.
// Thread-safety: immutable once made.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "engine/base/context.h"
#include "engine/base/geometry.h"
#include "engine/domain/domain.h"
#include "engine/parallel/quadtree.h"
#include "engine/refine/crossed_arms.h"
#include "engine/refine/quality_bounds.h"
#include "weft/error.h"

namespace weft {

class NarrowPlaces {
 public:
  // The two segments with the most triangles between them.
  struct Costliest {
    std::uint32_t segment;  // indices into Pslg::segments
    std::uint32_t other;
    Point at;  // on the first
    double width;
    double lower_bound;  // of the triangles
  };

  NarrowPlaces() = default;

  // `expected_area` returns the size near a point, the bound on the area of its triangles; infinity
  // for none. Several threads call it. Errors: kCancelled, kDeadlineExceeded.
  static Result<NarrowPlaces> find(const Domain& domain, const CrossedArms& crossed_arms,
                                   const QualityBounds& quality,
                                   const std::function<double(Point)>& expected_area,
                                   const ExecutionContext& context);

  // Triangles that the bound on angles makes beyond those that the size does.
  double expected() const { return expected_; }
  // A lower bound on the triangles of a mesh within the bound on angles, whatever the size: counts
  // only clean strips, each as 0.35 of its expected triangles. weft's meshes had at least 1.6 times
  // as many.
  double lower_bound() const { return lower_bound_; }
  const std::optional<Costliest>& costliest() const { return costliest_; }
  // Nine tenths of the lower bound lie where segments are no further apart than this.
  double widest() const { return widest_; }

  // How many triangles the bound on angles makes of a triangle of the domain elsewhere, on average:
  // 1.7 to 3.1, measured on coasts at 20 to 33 degrees.
  static double elsewhere(const QualityBounds& quality);

  // Adds samples where the triangles are expected, of at most `triangles_per_sample` triangles
  // each, or more if there would be more than 2^17 samples.
  void add_samples(double triangles_per_sample, std::vector<Quadtree::Sample>& samples) const;

  std::size_t bytes() const { return pieces_.capacity() * sizeof(Piece); }

 private:
  // A piece of a segment, with about the same width all along.
  struct Piece {
    Point from;
    Point to;
    double triangles;
  };
  class Search;

  std::vector<Piece> pieces_;
  double expected_ = 0;
  double lower_bound_ = 0;
  double widest_ = 0;
  std::optional<Costliest> costliest_;
};

}  // namespace weft

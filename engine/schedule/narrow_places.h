// SPDX-License-Identifier: Apache-2.0
// What the bound on angles costs where the domain is narrow: how many triangles, and where.
//
//   auto places = NarrowPlaces::find(domain, quality, likely_area, context);
//   places->likely();                              // triangles beyond those that the size makes
//   places->add_samples(1'000, samples);           // for the quadtree
//
// A triangle between two segments that run side by side is as short as the gap is wide, whatever
// the size allows, and the triangles around grow only slowly (Ruppert's local feature size). So a
// segment at a distance w from what it sees on either side costs a number of triangles in
// proportion to its length over w. Of the segments that stand at the base of a thin triangle of the
// domain, and only these can be near to anything for long, pieces are measured: halved until the
// nearest vertex or segment, seen through the triangles of the domain, is about as far along all of
// the piece. Vertices near a segment cost a logarithm, and so few pieces.
//
// How many triangles a unit of length / w stands for depends on the angle alone, to a factor of
// 1.5: measured on strips at 5 to 33 degrees (narrow_places.cpp).
//
// Arithmetic without functions of the C library but the root: the same bits on every machine.
// Thread-safety: immutable once made.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "engine/base/context.h"
#include "engine/base/error.h"
#include "engine/base/geometry.h"
#include "engine/domain/domain.h"
#include "engine/refine/quality_bounds.h"
#include "engine/schedule/quadtree.h"

namespace weft {

class NarrowPlaces {
 public:
  // The two segments between which the most triangles go.
  struct Costliest {
    std::uint32_t segment;  // indices into Pslg::segments
    std::uint32_t other;
    Point at;  // on the first
    double width;
    double least;  // triangles
  };

  NarrowPlaces() = default;

  // `likely_area` is the size about a point: the area that its triangles have at most; infinity
  // for none. It is called from several threads. Errors: kCancelled, kDeadlineExceeded.
  static Result<NarrowPlaces> find(const Domain& domain, const QualityBounds& quality,
                                   const std::function<double(Point)>& likely_area,
                                   const ExecutionContext& context);

  // Triangles that the bound on angles makes beyond those that the size does.
  double likely() const { return likely_; }
  // Triangles that a mesh within the bound on angles has at least, whatever the size: of clean
  // strips alone, each 0.4 of what is likely there. Our meshes had 1.6 times as many and more.
  double least() const { return least_; }
  const std::optional<Costliest>& costliest() const { return costliest_; }

  // What the bound on angles makes of a triangle of the domain elsewhere, on average: measured on
  // coasts at 20 to 33 degrees, 1.7 to 3.1.
  static double elsewhere(const QualityBounds& quality);

  // Adds the triangles where they are expected, at most `grain` a sample, or in more than 2^17
  // samples.
  void add_samples(double grain, std::vector<Quadtree::Sample>& samples) const;

  std::size_t bytes() const { return pieces_.capacity() * sizeof(Piece); }

 private:
  // Of a segment, with about the same width all along.
  struct Piece {
    Point from;
    Point to;
    double triangles;
  };
  class Search;

  std::vector<Piece> pieces_;
  double likely_ = 0;
  double least_ = 0;
  std::optional<Costliest> costliest_;
};

}  // namespace weft

// SPDX-License-Identifier: Apache-2.0
// Where layers lie: rows of thin triangles along walls, which are segments on the boundary. The
// line on which they end is laid out before the mesh, at their thickness from the walls; what is
// between the two is a hole of the domain that is meshed, and filled when the mesh is there
// (layer_filler.h). So refinement knows nothing of layers, and its bounds hold outside of them.
//
// A spoke leads from a corner of a wall to that line:
//
//     line    o-----------o---------o
//             |spoke      |          \ spokes of a corner that turns away by
//     wall    o-----------o------o    o more than 60 degrees: a fan
//                                 \  /
//
// Where the wall turns by a, it is 1 / cos(a / 2) times as long as the layers are thick, so that
// they are as thick beside it. At the end of a wall it lies on the next side, if that makes 45 to
// 135 degrees with the wall; else the layers end in a point.
//
// Layers are made thinner until they take at most 0.4 of the way to what is opposite, until corners
// shift no spoke by more than 0.4 of an edge, and until the thickness grows by at most half of the
// length of each edge.
//
//   auto plan = LayerPlan::of(request.layers, domain, tolerance, context);
//   triangulate(plan->with_holes(pslg, request.layers), context);
//
// Errors: kBadOption with the field quality.layers[i]; kLimitExceeded for more than a million edges
// of walls; kBudgetExceeded; what stopped the context. Immutable.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/base/context.h"
#include "engine/base/vector.h"
#include "engine/domain/domain.h"
#include "weft/error.h"
#include "weft/weft.h"

namespace weft {

// From a corner of the wall to the line.
struct Spoke {
  std::uint32_t vertex = 0;  // of the domain, at the wall
  // The domain's subsegment that it lies on, where a wall ends on another side; else kNone.
  std::uint32_t side = kNone;
  Point base;
  Point tip;  // `base` where the layers end in a point
};

// A segment of the line, from one spoke to another, the mesh at its left.
struct LinePiece {
  std::uint32_t first = 0, last = 0;  // indices into LayerPlan::spokes
  std::uint32_t layers = 0;           // index into MeshRequest::layers
  std::uint32_t wall = kNone;         // the domain's subsegment; kNone within a fan
};

class LayerPlan {
 public:
  // REQUIRES: the domain is that of the PSLG, without layers. Features nearer than `tolerance` are
  // merged.
  static Result<LayerPlan> of(const std::vector<Layers>& layers, const Domain& domain,
                              double tolerance, const ExecutionContext& context);

  const std::vector<Spoke>& spokes() const { return spokes_; }
  // Those of one wall follow each other. Piece i is segment `pslg.segments + i` of with_holes.
  const std::vector<LinePiece>& pieces() const { return pieces_; }
  // The PSLG, with the line, which has the walls' markers, and holes between it and the walls.
  Pslg with_holes(const Pslg& pslg, const std::vector<Layers>& layers) const;

  // The point of with_holes where a spoke begins.
  std::uint32_t point_of_base(std::uint32_t spoke, const Pslg& pslg) const {
    return static_cast<std::uint32_t>(pslg.points.size() + 2 * std::size_t{spoke});
  }
  // The segment of the PSLG that a segment of with_holes stands for: itself, or a wall's.
  std::uint32_t segment_of(std::uint32_t segment, const Pslg& pslg, const Domain& domain) const;

  // What is wrong with `domain`, that of with_holes: the holes are not what is between line and
  // walls in `before`, the domain of the PSLG, or the line is not whole.
  std::optional<Error> check(const Pslg& pslg, const Domain& before, const Domain& domain) const;

  double area() const { return area_; }  // that layers cover
  // The thinnest layers, of those that do not end in a point.
  double least_thickness() const { return least_; }
  Point thinnest_at() const { return thinnest_at_; }
  // Of layers whose thickness was cut, over all spokes that do not end in a point.
  std::size_t cut() const { return cut_; }
  // The least length of a piece of the line over that of its wall, of walls with the marker; at
  // most 1.
  double least_stretch(std::int32_t marker, const Domain& domain) const;

 private:
  friend class LayerPlanner;  // layer_plan.cpp

  std::vector<Spoke> spokes_;
  std::vector<LinePiece> pieces_;
  double area_ = 0;
  double least_ = 0;
  Point thinnest_at_{};
  std::size_t cut_ = 0;
};

// How thick the layers are.
double thickness_of(const Layers& layers);
// The height of the end of row i, from 0 on, over the thickness; 1 for the last.
std::vector<double> heights_of(const Layers& layers);

}  // namespace weft

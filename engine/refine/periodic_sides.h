// SPDX-License-Identifier: Apache-2.0
// Sides of the domain that repeat each other. A motion, which is a translation or a rotation, takes
// the one to the other, the inside of the domain there to its outside. It is found from the
// domain: each side is directed so that the inside is at its left, and the sum of its edges must
// come to the opposite of the sum of the other side's.
//
// First both sides get the domain's vertices of either. Then refinement sees two sides. After it,
// each vertex of one side whose image is no vertex of the other splits the edge there, and
// refinement goes on, until all have one. Segments are halved, or split on the same shells, so the
// splits of both sides are mostly the same. Corners of both sides that are near to each other may
// split each other's pieces again and again: once a side has four times the vertices that both had
// at first, both are kept as they are (Unrefined::kept).
//
//   auto sides = PeriodicSides::of(request.periodic, domain, tolerance);
//   if (sides->lacks_images()) ... triangulate sides->with_images(pslg) instead
//   corners.share_shells(sides->twins());
//   if (auto error = sides->match(refiner, mesh, corners, slots, context)) return error;
//
// Errors: kBadOption with the field quality.periodic[i] for sides that do not repeat each other.
// Thread-safety: immutable; it reads the mesh as its caller may.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/context.h"
#include "engine/base/vector.h"
#include "engine/domain/domain.h"
#include "engine/refine/acute_corners.h"
#include "engine/refine/cavity.h"
#include "engine/refine/storage/mesh_store.h"
#include "engine/refine/storage/slots.h"
#include "weft/error.h"
#include "weft/weft.h"

namespace weft {

// A translation, or a rotation of one point to another.
class Motion {
 public:
  Motion() = default;
  static Motion translation(Point from, Point to) { return {from, to, 1, 0}; }
  static Motion rotation(Point from, Point to, double cosine, double sine) {
    return {from, to, cosine, sine};
  }

  Motion inverse() const { return {to_, from_, cosine_, -sine_}; }
  Point operator()(Point p) const {
    // A shift of 0 changes nothing, to the bit.
    if (sine_ == 0 && cosine_ == 1) return {p.x + (to_.x - from_.x), p.y + (to_.y - from_.y)};
    const Vector v = p - from_;
    return {to_.x + (cosine_ * v.x - sine_ * v.y), to_.y + (sine_ * v.x + cosine_ * v.y)};
  }

 private:
  Motion(Point from, Point to, double cosine, double sine)
      : from_(from), to_(to), cosine_(cosine), sine_(sine) {}
  Point from_{}, to_{};
  double cosine_ = 1, sine_ = 0;
};

class PeriodicSides {
 public:
  PeriodicSides() = default;
  // Points nearer than `tolerance` are the same. Errors: also for a marker that no segment on the
  // boundary has, or that is named twice, and for arcs.
  static Result<PeriodicSides> of(const std::vector<PeriodicPair>& pairs, const Domain& domain,
                                  double tolerance);

  bool empty() const { return pairs_.empty(); }
  // Whether some vertices of the domain on sides have no images.
  bool lacks_images() const { return !images_.empty(); }
  // The PSLG with these images, which cut segments: what is cut off has a new number, after all
  // others. `origin` gets the old number of each of these.
  Pslg with_images(const Pslg& pslg, std::vector<std::uint32_t>& origin) const;

  // The ends of the domain's subsegments that have images.
  const std::vector<AcuteCorners::Twins>& twins() const { return twins_; }

  // Splits edges of the sides and refines what that has made, until the sides match. `slots` hold
  // all triangles. Errors: also those of refinement.
  template <class Refiner>
  std::optional<Error> match(Refiner& refiner, const MeshStore& mesh, const AcuteCorners& corners,
                             std::span<const Slots* const> slots,
                             const ExecutionContext& context) const {
    std::optional<std::size_t> most;
    while (!empty()) {
      const auto found = missing(mesh, corners, slots, context);
      if (!found) return found.error();
      if (found->splits.empty()) break;
      if (!most) most = kMaxGrowth * (found->edges + found->lacking);
      if (found->edges > *most) refiner.keep(markers());
      bool any = false;
      for (const Split& split : found->splits) any |= refiner.split(split.edge, split.at);
      if (!any) return refused(found->splits.front());
      if (auto error = refiner.run()) return error;
    }
    return std::nullopt;
  }

 private:
  static constexpr std::size_t kMaxGrowth = 4;

  struct Split {
    SegmentEdge edge;
    Point at;
    std::uint32_t pair;
  };
  struct Image {
    std::uint32_t segment;
    Point at;
  };
  // An edge of a side. Its ends are in the direction of the side `from` of its pair, and in that of
  // its image.
  struct Edge {
    std::uint32_t first, last;
    SegmentEdge edge;
  };
  using Side = std::vector<Edge>;  // by `first`
  struct Pair {
    std::array<std::int32_t, 2> markers;
    Motion motion;
  };

  // The splits that one pair needs (periodic_sides.cpp).
  class Matching;

  struct Missing {
    std::vector<Split> splits;  // at most one of an edge; their order is that of their places
    std::size_t lacking = 0;    // images in all
    std::size_t edges = 0;      // of all sides
  };
  Result<Missing> missing(const MeshStore& mesh, const AcuteCorners& corners,
                          std::span<const Slots* const> slots,
                          const ExecutionContext& context) const;
  std::vector<std::int32_t> markers() const;
  static Error refused(const Split& split);

  std::vector<Pair> pairs_;
  std::vector<AcuteCorners::Twins> twins_;
  std::vector<Image> images_;  // that the domain lacks
  double tolerance_ = 0;
};

}  // namespace weft

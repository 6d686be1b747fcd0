// SPDX-License-Identifier: Apache-2.0
// How long edges on segments may be, and which segments are kept as they are, by the marker of the
// segment.
//
// Long pieces of segments are split before triangles are refined, into equal parts but at small
// angles (acute_corners.h). Refinement only makes them shorter. Rounding may leave an edge longer
// by 1e-9 of its limit and 2^-50 of its coordinates.
//
//   EdgeLimits limits(size.at, request.keep);
//   if (limits.pieces(marker, a, b) > 1) ... the edge from a to b is too long
//   if (limits.keep(marker)) ... no vertex is put on it
//
// Units: lengths of the domain. Thread-safety: immutable.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/geometry.h"
#include "engine/base/vector.h"
#include "engine/domain/domain.h"
#include "engine/domain/markers.h"
#include "engine/refine/storage/mesh_store.h"
#include "weft/error.h"
#include "weft/weft.h"

namespace weft {

class EdgeLimits {
 public:
  EdgeLimits() = default;
  // REQUIRES: lengths that are positive and finite, each for a marker of its own. `keep` is that of
  // MeshRequest.
  explicit EdgeLimits(std::vector<SizeAt> at,
                      std::optional<std::vector<std::int32_t>> keep = std::nullopt)
      : at_(std::move(at)), keep_all_(keep && keep->empty()) {
    std::sort(at_.begin(), at_.end(),
              [](const SizeAt& a, const SizeAt& b) { return a.marker < b.marker; });
    if (keep) keep_.emplace(std::move(*keep));
  }

  bool keep_any() const { return keep_.has_value(); }
  bool keep(std::int32_t marker) const { return keep_ && (keep_all_ || keep_->contains(marker)); }

  bool empty() const { return at_.empty(); }

  // Around an edge on a segment whose length is limited, roughly: 3.9 as measured, if the bound on
  // angles alone makes triangles grow from there.
  static constexpr double kTrianglesPerPiece = 4;

  // The least number of equal parts of the edge from a to b that keep to the limit of its marker.
  double pieces(std::int32_t marker, Point a, Point b) const {
    const auto found =
        std::lower_bound(at_.begin(), at_.end(), marker,
                         [](const SizeAt& at, std::int32_t m) { return at.marker < m; });
    if (found == at_.end() || found->marker != marker) return 1;
    const double magnitude =
        std::max({std::fabs(a.x), std::fabs(a.y), std::fabs(b.x), std::fabs(b.y)});
    const double slack = 1e-9 * found->max_edge + 0x1p-50 * magnitude;
    return std::max(1.0, std::ceil((length(b - a) - slack) / found->max_edge));
  }

  // A lower bound on the triangles of a mesh with so many edges on segments: each edge belongs to
  // one, and a triangle has several only at a corner between two subsegments of the domain.
  static double triangles_lower_bound(double pieces, const Domain& domain) {
    constexpr double kSides = 3;
    const double corners = 2 * static_cast<double>(domain.subsegments.size());
    return std::max(pieces / kSides, pieces - corners);
  }

  // A lower bound on the bytes of the mesh once its segments are split, which is before any part of
  // it can leave: each piece but the first of a segment is a vertex, and adds a triangle at least.
  static double bytes_lower_bound(double pieces, const Domain& domain) {
    constexpr double kBytesPerPiece =
        sizeof(Triangle) + sizeof(Point) + sizeof(std::uint32_t);  // its segment
    return kBytesPerPiece * std::max(0.0, pieces - static_cast<double>(domain.subsegments.size()));
  }

  // How many edges the limits ask for, on all segments that have one.
  double pieces(const Domain& domain) const {
    double sum = 0;
    if (empty()) return sum;
    for (const Subsegment& s : domain.subsegments) {
      const double pieces = this->pieces(s.marker, domain.vertices[s.a], domain.vertices[s.b]);
      if (pieces > 1) sum += pieces;
    }
    return sum;
  }

 private:
  std::vector<SizeAt> at_;  // by marker
  std::optional<MarkerSet> keep_;
  bool keep_all_ = false;
};

// Edges on segments come out between half their limit and the whole limit, so `least` is twice the
// shortest edge. Errors: kBadOption for a length below it, a length at a marker that is kept, an
// arc that is to be kept, and a marker to keep that no segment has. `limits` are those of the
// request. REQUIRES: a PSLG that `validate` accepts.
std::optional<Error> check_edge_limits(const MeshRequest& request, const EdgeLimits& limits,
                                       double least);

}  // namespace weft

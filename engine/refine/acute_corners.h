// SPDX-License-Identifier: Apache-2.0
// Small input angles. If two segments, the arms, meet at less than 60 degrees inside the domain,
// splitting one at its midpoint may encroach upon the other for ever. So arms are split at equal
// distances from their corner (concentric shells: Ruppert 1995), and a skinny triangle whose
// shortest edge joins two arms at the same distance is left as it is (Miller, Pav and Walkington
// 2003): splitting it could only make edges shorter, because its angle comes from the input.
//
// A piece of an arm is split:
//   - at the distance of the vertex that faces it, if that vertex is on another arm of the corner,
//     the distance is in the middle half of the piece, and the vertex is nearer to the piece than a
//     tenth of its length;
//   - otherwise at the coarsest multiple of a power of two in the middle third of its distances to
//     a corner. Of the ends of the arm that have shells, and the corners that it keeps beyond what
//     crosses it (crossed_arms.h), the one counts whose other arm is nearest to the middle of the
//     piece, by the angle between the two.
//
// Two vertices are at the same distance if rounding explains the difference: 2^-47 of the largest
// coordinate of the three points. The checker allows twice that (checker/mesh/exemption.h).
//
// Arms may be arcs: the angle at a corner is that of the tangents or that of the chords, whichever
// is smaller, and a distance from the corner is taken along a straight line. An arc that is no arm
// is split in its middle, where the bisector of the chord meets it.
//
// If the bound on angles is above 30 degrees, arms that meet at less than 93 degrees are split on
// shells, too, but this exempts no triangle. docs/termination.md says why, and what each rule
// saves.
//
// An input vertex that ends an arm counts as on a shell, but two of them do not exempt a triangle:
// a fan of equal arms is refined toward its corner.
//
// Errors: those of `build`. Thread-safety: immutable once built; it reads the mesh as its caller
// may.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/base/context.h"
#include "engine/domain/domain.h"
#include "engine/refine/crossed_arms.h"
#include "engine/refine/needles.h"
#include "engine/refine/quality_bounds.h"
#include "engine/refine/storage/mesh_store.h"
#include "weft/error.h"

namespace weft {

class AcuteCorners {
 public:
  // Difference of two distances that rounding explains, over the largest coordinate.
  static constexpr double kSameDistance = 0x1p-47;

  // For meshes within these bounds. Keeps a reference to the domain's subsegments. Errors:
  // kCancelled, kDeadlineExceeded.
  static Result<AcuteCorners> build(const Domain& domain, const QualityBounds& quality,
                                    const ExecutionContext& context);

  // A subsegment at one of its ends, and its image on a side that repeats its own.
  struct Twins {
    std::array<std::uint32_t, 2> subsegments;
    std::array<std::uint32_t, 2> ends;  // vertices of the domain
  };
  // Has twins split alike: on the shells of the corner of either.
  void share_shells(const std::vector<Twins>& twins);

  // Two vertices of the mesh.
  using Pair = std::array<std::uint32_t, 2>;

  // Where to split the piece of a segment between two vertices: as above on an arm, otherwise after
  // that `fraction` of the way. `apexes` face the piece from its two sides; kNone if a side has no
  // triangle.
  Point split_point(const MeshStore& mesh, Pair ends, Pair apexes, double fraction) const;

  bool has_arcs() const { return !curvatures_->empty(); }
  // Of the arc that a subsegment is, from its a to its b; 0 if it is straight.
  double curvature(std::uint32_t subsegment) const {
    return has_arcs() ? (*curvatures_)[subsegment] : 0;
  }
  const CrossedArms& crossed_arms() const { return crossed_; }
  // The places where two of the domain's segments meet at a small angle outside of it.
  const Needles& needles() const { return needles_; }

  // Whether a skinny triangle stays because of a small input angle.
  bool exempts(const MeshStore& mesh, const Triangle& triangle) const;

  // Index into Domain::subsegments of the edge a-b, which must lie on a segment.
  std::uint32_t subsegment(const MeshStore& mesh, std::uint32_t a, std::uint32_t b) const;
  // Of the segment that the edge a-b lies on.
  std::int32_t marker(const MeshStore& mesh, std::uint32_t a, std::uint32_t b) const {
    return (*subsegments_)[subsegment(mesh, a, b)].marker;
  }

  std::uint64_t bytes() const {
    return corners_.size() + sines_.size() * sizeof(sines_[0]) + by_ends_.size() * sizeof(Ends) +
           first_.size() * sizeof(std::uint32_t) + crossed_.bytes() + needles_.bytes();
  }

 private:
  struct Ends {
    std::uint32_t b;  // the higher one
    std::uint32_t subsegment;
  };

  // The kind of a corner, by the smallest angle at which two arms meet there.
  enum class Corner : char { kPlain, kShells, kAcute };

  explicit AcuteCorners(const Domain& domain)
      : subsegments_(&domain.subsegments),
        curvatures_(&domain.curvatures),
        corners_(domain.vertices.size(), Corner::kPlain),
        sines_(domain.subsegments.size(), {1, 1}) {}
  // Returns the sectors below CrossedArms::kSharp.
  Result<std::vector<CrossedArms::Sector>> find_corners(const Domain& domain, bool at_right_angles,
                                                        const ExecutionContext& context);
  std::optional<Error> sort_by_ends(const Domain& domain, const ExecutionContext& context);

  Corner corner(std::uint32_t vertex) const {
    return vertex < corners_.size() ? corners_[vertex] : Corner::kPlain;
  }
  float& sine_at(std::uint32_t subsegment, std::uint32_t end) {
    return sines_[subsegment][(*subsegments_)[subsegment].b == end ? 1 : 0];
  }
  bool acute(std::uint32_t vertex) const { return corner(vertex) == Corner::kAcute; }
  bool has_shells(std::uint32_t vertex) const { return corner(vertex) != Corner::kPlain; }
  // The subsegment between two vertices of the domain, or kNone.
  std::uint32_t subsegment_between(std::uint32_t a, std::uint32_t b) const;
  // Whether the vertex lies on, or ends, an arm of the corner other than that of this subsegment.
  bool on_other_arm(const MeshStore& mesh, std::uint32_t vertex, std::uint32_t corner,
                    std::uint32_t subsegment) const;

  // The place of a split, as a fraction of the way from one end of a piece to the other: of their
  // distances from the corner; its middle, and kNone, if no shell is near to that.
  struct Shell {
    double fraction;
    std::uint32_t corner;
  };
  std::optional<Shell> matching_shell(const MeshStore& mesh, std::uint32_t subsegment, Point from,
                                      Point to, Pair apexes) const;
  Shell dyadic_shell(const MeshStore& mesh, std::uint32_t subsegment, Point from, Point to) const;
  std::optional<Shell> shell(const MeshStore& mesh, std::uint32_t subsegment, Point from, Point to,
                             Pair apexes) const;
  Point split_arc(const MeshStore& mesh, std::uint32_t subsegment, Point from, Point to,
                  std::optional<Shell> shell, double fraction) const;

  const std::vector<Subsegment>* subsegments_;
  const std::vector<double>* curvatures_;  // see Domain
  std::vector<Corner> corners_;            // per vertex of the domain
  // Per subsegment, at its ends a and b: of the smallest angle to another arm.
  std::vector<std::array<float, 2>> sines_;
  std::vector<Ends> by_ends_;         // by the lower end, then by the higher
  std::vector<std::uint32_t> first_;  // per vertex of the domain: its first in by_ends_
  CrossedArms crossed_;
  Needles needles_;
};

}  // namespace weft

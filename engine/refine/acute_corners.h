// SPDX-License-Identifier: GPL-3.0-or-later
// Small input angles. Where two segments meet at less than 60 degrees inside the domain, splitting
// one at its midpoint may encroach upon the other for ever. So such corners get concentric shells:
// a subsegment that ends at an acute vertex is split at a power of two from it (Ruppert 1995), the
// pieces of both segments end at equal distances, and a skinny triangle whose shortest edge joins
// two such points is left as it is (Miller, Pav and Walkington 2003; Triangle does the same):
// splitting it could only make edges shorter, for its angle comes from the input.
// Plain Ruppert wastes 2.6 times the vertices on a wedge of 3 degrees, and never ends on a star of
// 36 rays.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/context.h"
#include "engine/domain/domain.h"
#include "engine/error.h"
#include "engine/refine/mesh.h"

namespace weft {

class AcuteCorners {
 public:
  // Keeps a reference to the domain's subsegments. Errors: kCancelled, kDeadlineExceeded.
  static Result<AcuteCorners> build(const Domain& domain, const ExecutionContext& context);

  // Where to split the subsegment between two mesh vertices: at a power of two from its end if
  // exactly one is acute, else in the middle.
  Point split_point(const Mesh& mesh, std::uint32_t a, std::uint32_t b) const;

  // Whether a skinny triangle is to stay because of a small input angle.
  bool excuses(const Mesh& mesh, const Triangle& triangle) const;

  // Index into Domain::subsegments of the edge a-b, which must lie on a segment.
  std::uint32_t subsegment(const Mesh& mesh, std::uint32_t a, std::uint32_t b) const;

  std::uint64_t bytes() const {
    return acute_.size() + by_ends_.size() * sizeof(Ends) + first_.size() * sizeof(std::uint32_t);
  }

 private:
  struct Ends {
    std::uint32_t b;  // the higher one
    std::uint32_t subsegment;
  };

  explicit AcuteCorners(const Domain& domain)
      : subsegments_(&domain.subsegments), acute_(domain.vertices.size(), 0) {}
  std::optional<Error> find_acute_vertices(const Domain& domain, const ExecutionContext& context);
  std::optional<Error> sort_by_ends(const Domain& domain, const ExecutionContext& context);

  bool acute(std::uint32_t vertex) const { return vertex < acute_.size() && acute_[vertex]; }

  const std::vector<Subsegment>* subsegments_;
  std::vector<char> acute_;           // per vertex of the domain
  std::vector<Ends> by_ends_;         // by the lower end
  std::vector<std::uint32_t> first_;  // per vertex of the domain: its first in by_ends_
};

}  // namespace weft

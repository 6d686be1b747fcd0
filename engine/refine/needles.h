// SPDX-License-Identifier: Apache-2.0
// Needles: places where two segments, the arms, meet at a small angle outside the domain. There is
// no triangle between the arms to show that a vertex on one was rounded onto the other. So no
// vertex is put where the arms are nearer to each other than 16 units in the last place: twice the
// 5 that a vertex may be off its arm (split_segment in refiner.h), and a margin.
//
// Two arcs that touch are a needle, too. If they curve the same way, the chord of the one may lie
// beyond vertices of the other, and nothing between them would show it: that is an error.
//
//   const Result<Needles> needles = Needles::find(domain, context);
//   if (!needles->keep_apart(subsegment, split)) ...
//
// Thread-safety: immutable once found.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/base/context.h"
#include "engine/domain/domain.h"
#include "weft/error.h"

namespace weft {

class Needles {
 public:
  // Errors: kBadOption, kCancelled, kDeadlineExceeded.
  static Result<Needles> find(const Domain& domain, const ExecutionContext& context);

  // Whether a split of the subsegment there stays apart from its needles' other arms.
  bool keep_apart(std::uint32_t subsegment, Point split) const;

  std::uint64_t bytes() const { return ends_.size() * sizeof(End); }

 private:
  // An end of a subsegment, and the distance from it within which the other arm is too near.
  struct End {
    std::uint32_t subsegment;
    Point corner;
    double distance;
  };
  // A boundary edge, or an arm: the first end is the corner then.
  struct Edge {
    std::uint32_t from, to, subsegment;
    bool domain_is_left;
  };
  using Edges = std::vector<Edge>;

  static Result<Edges> boundary(const Domain& domain, const ExecutionContext& context);
  void add_fan(const Domain& domain, Edges arms);
  void add(const Domain& domain, const Edge& arm, const Edge& other);
  void add_contact(const Domain& domain, const Edge& right, const Edge& left);

  double apart_ = 0;             // how far apart arms must be
  std::vector<End> ends_;        // by subsegment
  std::optional<Error> nested_;  // the first two arcs that touch and curve the same way
};

}  // namespace weft

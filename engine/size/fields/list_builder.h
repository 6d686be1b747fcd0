// SPDX-License-Identifier: Apache-2.0
// Builds a part of a distance field's quadtree (distance_field.h): its nodes, the root first, and
// the lists of its leaves.
//
//   ListBuilder builder(field, cover, last_level, context);
//   if (auto error = builder.build(std::move(root))) return error;
//   use(builder.nodes, builder.lists, builder.later);
//
// Errors: kCancelled, kDeadlineExceeded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/context.h"
#include "engine/base/geometry.h"
#include "engine/size/domain_cover.h"
#include "engine/size/fields/distance_field.h"
#include "weft/error.h"

namespace weft {

// Not thread-safe: one per thread.
class ListBuilder {
 public:
  using Node = DistanceField::Node;
  // A node that is still to be built: its box, and the lines that may be nearest in it.
  struct Pending {
    std::uint32_t node = 0;
    int depth = 0;
    std::uint32_t ix = 0;
    std::uint32_t iy = 0;
    double distance = 0;        // at the middle of the box
    std::uint64_t allowed = 0;  // for its subtree
    std::vector<std::uint32_t> lines;
  };

  // Nodes at `last_level` that are to be split stay in `later`.
  ListBuilder(const DistanceField& field, const DomainCover& cover, int last_level,
              const ExecutionContext& context)
      : field_(field), cover_(cover), last_level_(last_level), context_(context) {}

  std::optional<Error> build(Pending&& root) {
    nodes.assign(1, {});
    root.node = 0;
    return split(std::move(root));
  }

  std::vector<Node> nodes;
  std::vector<std::uint32_t> lists;
  std::vector<Pending> later;
  double looks = 0;  // boxes of the tree and lines that a search visits, summed over the leaves
  std::size_t leaves = 0;

 private:
  // Points of a box that is divided: the corners of its four parts, row by row, then their middles.
  static constexpr std::size_t kCorners = 9;
  static constexpr std::size_t kSamples = kCorners + 4;
  static constexpr int kPairs = (kSamples + 1) / 2;
  struct Squares {
    alignas(16) double of[2 * kPairs];  // the last one is of no sample
  };
  struct Samples {
    Squares x;
    Squares y;
    Squares least;  // square of the distance to any of the lines
    std::uint32_t nearest[kSamples] = {};
  };

  std::optional<Error> split(Pending&& pending);
  std::optional<Error> share_out(const Pending& pending, Pending (&parts)[4]);
  std::optional<Error> take(const std::vector<std::uint32_t>& lines, Samples& samples);
  std::optional<Error> filter(const std::vector<std::uint32_t>& lines, const Samples& samples,
                              unsigned part, std::vector<std::uint32_t>& kept);
  void add_leaf(const Pending& pending);
  Box box_of(const Pending& pending) const;
  Point middle_of(const Pending& pending) const;

  const DistanceField& field_;
  const DomainCover& cover_;
  const int last_level_;
  const ExecutionContext& context_;
  std::vector<Squares> squares_;  // scratch memory of `share_out`, for each line
};

}  // namespace weft

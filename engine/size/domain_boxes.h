// SPDX-License-Identifier: Apache-2.0
// A level of a quadtree over a domain: boxes, each with the triangles that it overlaps, which its
// children inherit.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <optional>
#include <vector>

#include "engine/base/context.h"
#include "engine/base/geometry.h"
#include "engine/domain/domain.h"
#include "engine/size/box_overlap.h"
#include "weft/error.h"

namespace weft {

// The square that a quadtree over the domain begins with.
inline Box root_square(const Domain& domain) {
  Box box;
  for (const Point p : domain.vertices) box.add(p);
  const double side = std::max(box.width(), box.height());
  return {box.min_x, box.min_y, box.min_x + side, box.min_y + side};
}

struct DomainBox {
  Box box;
  std::uint32_t first = 0;  // of the level's triangles
  std::uint32_t count = 0;  // 0: outside the domain
  bool inside = false;      // in the only one
};

// Polls now and then: one box may overlap millions of triangles.
class TrianglePoll {
 public:
  explicit TrianglePoll(const ExecutionContext& context) : context_(context) {}
  std::optional<Error> operator()() {
    constexpr std::uint32_t kInterval = 1 << 14;
    return ++count_ % kInterval == 0 ? context_.poll() : std::nullopt;
  }

 private:
  const ExecutionContext& context_;
  std::uint32_t count_ = 0;
};

// The box of a first level, which overlaps all triangles: sets them.
inline DomainBox whole_domain(const Domain& domain, const Box& box,
                              std::vector<std::uint32_t>& level_triangles) {
  level_triangles.resize(domain.triangles.size());
  std::iota(level_triangles.begin(), level_triangles.end(), 0u);
  return {box, 0, static_cast<std::uint32_t>(level_triangles.size()), false};
}

// Sets the children of `parent`, in Morton order, and appends the triangles that each overlaps to
// `triangles`. Errors: those of the poll.
inline std::optional<Error> split(const DomainBox& parent, const std::uint32_t* level_triangles,
                                  const Domain& domain, TrianglePoll& poll,
                                  std::array<DomainBox, 4>& children,
                                  std::vector<std::uint32_t>& triangles) {
  const std::uint32_t* const from = level_triangles + parent.first;
  const bool inside =
      parent.inside || (parent.count == 1 && weft::inside(parent.box, corners_of(domain, from[0])));
  for (unsigned c = 0; c < 4; ++c) {
    DomainBox& child = children[c];
    child = {child_box(parent.box, c), static_cast<std::uint32_t>(triangles.size()), 0, inside};
    for (std::uint32_t i = 0; i < parent.count; ++i) {
      if (auto error = poll()) return error;
      if (!inside && !overlap(child.box, corners_of(domain, from[i]))) continue;
      triangles.push_back(from[i]);
      ++child.count;
    }
  }
  return std::nullopt;
}

}  // namespace weft

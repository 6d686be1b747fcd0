// SPDX-License-Identifier: Apache-2.0
// A chain ends only at ends of segments, whatever the merging distance excuses.
#include <gtest/gtest.h>

#include "tests/checker/lattice.h"

namespace weft::check::testing {
namespace {

Vec2 at(int i, int j) {
  return Lattice::at({i, j});
}

// A line in a block. One of its ends has another point within the merging distance, so the line
// may be bent, and a piece of it that is as long as an edge may be a tear.
Problem bent_line() {
  Problem problem =
      Lattice(6).box({0, 0}, {6, 6}).segment({1, 3}, {5, 3}, 3).build([](Lattice::Node) {
        return true;
      });
  problem.domain.snap = 0.3;
  problem.domain.points.push_back({at(1, 3).x + 0.1, at(1, 3).y});
  return problem;
}

TEST(ChainEnds, AnInterruptedChainIsAViolation) {
  Problem problem = bent_line();
  EXPECT_TRUE(problem.check().ok()) << to_text(problem.check());
  Mesh& mesh = problem.mesh;
  mesh.edges.erase(mesh.edges.begin() +
                   static_cast<std::ptrdiff_t>(listed_edge(mesh, at(2, 3), at(3, 3))));
  const Report report = problem.check();
  EXPECT_EQ(violated(report), std::set<Rule>{Rule::kChains});
  EXPECT_NE(to_text(report).find("which is no end of a segment"), std::string::npos)
      << to_text(report);
}

TEST(ChainEnds, AnEndMayHaveMoved) {
  // Onto a point beside it, which is not on the line.
  Problem problem = bent_line();
  Domain& domain = problem.domain;
  const Vec2 moved{at(1, 3).x + 0.1, at(1, 3).y};
  for (Vec2& p : domain.points)
    if (p == at(1, 3)) p = moved;
  domain.points.back() = at(1, 3);
  const Report report = problem.check();
  EXPECT_TRUE(report.ok()) << to_text(report);
}

}  // namespace
}  // namespace weft::check::testing

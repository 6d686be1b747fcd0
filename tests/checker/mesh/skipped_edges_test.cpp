// SPDX-License-Identifier: Apache-2.0
// No edge inside the mesh lies on a gap of a chain, whatever the merging distance excuses.
#include <gtest/gtest.h>

#include "tests/checker/lattice.h"

namespace weft::check::testing {
namespace {

Vec2 at(int i, int j) {
  return Lattice::at({i, j});
}

// A segment in a block that is one edge. Its end has another point within the merging distance, so
// it may be bent, and a gap of its length may be a tear.
Problem bent_edge() {
  Problem problem =
      Lattice(6).box({0, 0}, {6, 6}).segment({2, 3}, {3, 3}, 3).build([](Lattice::Node) {
        return true;
      });
  problem.domain.snap = 0.3;
  problem.domain.points.push_back({at(2, 3).x + 0.1, at(2, 3).y});
  return problem;
}

TEST(SkippedEdges, ASegmentThatIsNotListedIsAViolation) {
  Problem problem = bent_edge();
  EXPECT_TRUE(problem.check().ok()) << to_text(problem.check());
  Mesh& mesh = problem.mesh;
  mesh.edges.erase(mesh.edges.begin() +
                   static_cast<std::ptrdiff_t>(listed_edge(mesh, at(2, 3), at(3, 3))));
  const Report report = problem.check();
  EXPECT_EQ(violated(report), std::set<Rule>{Rule::kChains});
  EXPECT_NE(to_text(report).find("of its chain is not listed"), std::string::npos)
      << to_text(report);
}

TEST(SkippedEdges, AGapOutsideIsNone) {
  Problem problem = bent_edge();
  Domain& domain = problem.domain;
  const auto first = static_cast<std::uint32_t>(domain.points.size());
  domain.points.insert(domain.points.end(), {{-4, 2}, {-4, 2.1}, {-5, 3}});
  domain.segments.push_back({first, first + 2});
  domain.markers.push_back(0);
  const Report report = problem.check();
  EXPECT_TRUE(report.ok()) << to_text(report);
}

}  // namespace
}  // namespace weft::check::testing

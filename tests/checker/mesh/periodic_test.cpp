// SPDX-License-Identifier: Apache-2.0
// Sides that repeat each other.
#include "checker/mesh/periodic.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/checker/lattice.h"

namespace weft::check::testing {
namespace {

using Rules = std::set<Rule>;

// A block of 2 x 2 cells with the marker 1 below, 2 at its right, 3 above, 4 at its left.
Problem block_with_sides() {
  Lattice lattice(2);
  lattice.segment({0, 0}, {2, 0}, 1).segment({2, 0}, {2, 2}, 2);
  lattice.segment({2, 2}, {0, 2}, 3).segment({0, 2}, {0, 0}, 4);
  Problem problem = lattice.build([](Lattice::Node) { return true; });
  problem.requirements.periodic = {{4, 2}, {1, 3}};
  return problem;
}

TEST(PeriodicRule, OfAShearedCellMatch) {
  const Problem problem = block_with_sides();
  EXPECT_TRUE(problem.check().ok()) << to_text(problem.check());
}

// At the middle of one side, a vertex that is moved along it.
TEST(PeriodicRule, AVertexWithoutImageIsAViolation) {
  Problem problem = block_with_sides();
  problem.requirements.max_area = 1;
  const Vec2 middle = Lattice::at({2, 1});
  problem.mesh.vertices[vertex(problem.mesh, middle)] = {middle.x + 0x1p-10, middle.y + 0x1p-9};
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kPeriodic}) << to_text(report);
  EXPECT_NE(to_text(report).find("on the side with marker 4 has no image at ("), std::string::npos)
      << to_text(report);
}

TEST(PeriodicRule, OfDifferentEdgesAreAViolation) {
  Problem problem = block_with_sides();
  problem.requirements.periodic = {{4, 7}};
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kPeriodic});
  EXPECT_NE(to_text(report).find("the sides with markers 4 and 7 have 2 and 0 edges"),
            std::string::npos)
      << to_text(report);
}

// The lower side is 2 long, the left one the root of 5: no motion takes one to the other. A square
// that is turned about a corner repeats itself there.
TEST(PeriodicRule, MayBeTurned) {
  Problem problem = block_with_sides();
  problem.requirements.periodic = {{1, 4}};
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kPeriodic});
  Problem square;
  square.domain.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  square.domain.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  square.domain.markers = {1, 2, 3, 4};
  square.mesh.vertices = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  square.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  square.mesh.regions = {0, 0};
  square.mesh.edges = {{0, 1, 1}, {1, 2, 2}, {2, 3, 3}, {3, 0, 4}};
  square.requirements.periodic = {{1, 4}, {2, 3}};
  EXPECT_TRUE(square.check().ok()) << to_text(square.check());
}

}  // namespace
}  // namespace weft::check::testing

// SPDX-License-Identifier: Apache-2.0
// What a run reports of its progress, sampled whenever a chunk leaves.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "engine/base/arena.h"
#include "engine/engine.h"
#include "tests/engine/domain/shapes.h"
#include "tests/support/collected_mesh.h"

namespace weft {
namespace {

// Keeps the fraction at each chunk, too.
class Sampler : public CollectedMesh {
 public:
  explicit Sampler(const ExecutionContext& context) : context_(context) {}
  bool accept(Chunk&& chunk) override {
    fractions.push_back(context_.progress().fraction);
    return CollectedMesh::accept(std::move(chunk));
  }
  std::vector<double> fractions;

 private:
  const ExecutionContext& context_;
};

// The fraction at each chunk, then at the end.
std::vector<double> fractions_of(const MeshRequest& request, const Budget& budget = {}) {
  Arena arena(2);
  ExecutionContext context(budget);
  context.set_arena(arena);
  Sampler sampler(context);
  const auto summary = generate_mesh(request, sampler, context);
  EXPECT_TRUE(summary) << summary.error().message;
  if (!summary) return {};
  EXPECT_EQ(verdict(request, sampler, *summary), "");
  sampler.fractions.push_back(context.progress().fraction);
  return sampler.fractions;
}

TEST(Fraction, RisesToOneWhileLeavesAreRefinedAndSent) {
  const auto fractions = fractions_of({.pslg = square(), .size = 2e-5, .leaf_triangles = 500});
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_LT(fractions.front(), 0.5);
  EXPECT_TRUE(std::any_of(fractions.begin(), fractions.end(),
                          [](double f) { return f > 0.5 && f < 0.95; }));
  EXPECT_NEAR(fractions.back(), 1, 1e-9);
}

TEST(Fraction, IsOneAtTheEndOfAMeshOfOneTask) {
  EXPECT_EQ(fractions_of({.pslg = square(), .size = 1e-3}).back(), 1);
}

TEST(Fraction, OfAMeshThatIsTruncatedIsOfTheTrianglesAllowed) {
  Budget budget;
  budget.max_triangles = 5'000;
  ExecutionContext context(budget);
  CollectedMesh mesh;
  const MeshRequest request{.pslg = square(), .size = 1e-6};
  ASSERT_TRUE(generate_mesh(request, mesh, context));
  EXPECT_EQ(context.progress().expected_triangles, 5'000u);
  EXPECT_EQ(context.progress().fraction, 1);
}

// What can be seen while one task refines, before any chunk has left.
TEST(Fraction, FollowsTheTrianglesWhereOneTaskMakesThem) {
  ExecutionContext context;
  context.report_expected(1'000);
  context.count_triangles_as(0.5);
  context.add_triangles(250);
  EXPECT_EQ(context.progress().fraction, 0.125);
  context.add_triangles(10'000);
  EXPECT_EQ(context.progress().fraction, 0.5);
  context.add_fraction(1);
  EXPECT_EQ(context.progress().fraction, 1);
}

}  // namespace
}  // namespace weft

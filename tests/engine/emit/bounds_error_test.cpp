// SPDX-License-Identifier: Apache-2.0
// A mesh that is not what was asked for ends with an error, unless the caller allows it.
#include "engine/emit/bounds_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "engine/base/arena.h"
#include "engine/domain/domain.h"
#include "engine/emit/fragment.h"
#include "engine/engine.h"
#include "engine/refine/area_bound.h"
#include "engine/refine/storage/mesh_store.h"
#include "engine/refine/storage/slots.h"
#include "tests/engine/domain/shapes.h"
#include "tests/support/collected_mesh.h"

namespace weft {
namespace {

// A unit square so far from the origin that its coordinates are 1e-10 apart, and a size that asks
// for edges shorter than that in its lower left corner, and for triangles of `largest` elsewhere.
MeshRequest below_precision(const std::string& largest = "1e-3") {
  MeshRequest request{.pslg = square()};
  for (Point& p : request.pslg.points) p = {p.x + 1e6, p.y + 1e6};
  request.size = "min(" + largest + ", 1e-24 + 0.1*((x-1e6)^2 + (y-1e6)^2))";
  return request;
}

struct Outcome {
  CollectedMesh mesh;
  Result<Summary> summary;
};

Outcome outcome_of(const MeshRequest& request, int threads = 1) {
  Arena arena(threads);
  ExecutionContext context;
  context.set_arena(arena, threads);
  Outcome outcome{{}, fail(ErrorCode::kInternal, "", "")};
  outcome.summary = generate_mesh(request, outcome.mesh, context);
  return outcome;
}

TEST(BoundsError, NamesHowManyTrianglesMissWhichBoundWhyAndWhere) {
  const Outcome outcome = outcome_of(below_precision());
  ASSERT_FALSE(outcome.summary);
  const Error& error = outcome.summary.error();
  EXPECT_EQ(error.code, ErrorCode::kBoundsNotMet);
  EXPECT_EQ(error.field, "");
  EXPECT_NE(error.message.find("triangles miss the bound on their area because double precision "
                               "ends; the first is at (1000000.0000"),
            std::string::npos)
      << error.message;
}

TEST(BoundsError, IsNoneForACallerWhoAllowsIt) {
  MeshRequest request = below_precision();
  request.allow_unrefined = true;
  const Outcome outcome = outcome_of(request);
  ASSERT_TRUE(outcome.summary) << outcome.summary.error().message;
  const Summary& summary = *outcome.summary;
  EXPECT_EQ(verdict(request, outcome.mesh, summary), "");
  EXPECT_GT(summary.unrefined.precision, 0u);
  EXPECT_GT(summary.unrefined.too_large, 0u);
  EXPECT_EQ(summary.unrefined.streaming, 0u);
  EXPECT_EQ(summary.unrefined.budget, 0u);
  EXPECT_EQ(summary.unrefined.edge_floor, 0u);
  EXPECT_LT(std::hypot(summary.unrefined_at.x - 1e6, summary.unrefined_at.y - 1e6), 1e-3);
}

TEST(BoundsError, IsNoneIfTheCallersOwnShortestEdgeIsReachedFirst) {
  MeshRequest request = below_precision();
  request.min_edge = 1e-3;
  const Outcome outcome = outcome_of(request);
  ASSERT_TRUE(outcome.summary) << outcome.summary.error().message;
  EXPECT_GT(outcome.summary->unrefined.edge_floor, 0u);
  EXPECT_EQ(outcome.summary->unrefined.precision, 0u);
}

TEST(BoundsError, ComesIfTheShortestEdgeThatTheCallerAllowsIsBelowPrecision) {
  MeshRequest request = below_precision();
  request.min_edge = 1e-13;
  const Outcome outcome = outcome_of(request);
  ASSERT_FALSE(outcome.summary);
  EXPECT_EQ(outcome.summary.error().code, ErrorCode::kBoundsNotMet);
}

TEST(BoundsError, IsNoneForWhatTheCallersBudgetLeaves) {
  MeshRequest request{.pslg = square(), .size = 1e-6};
  CollectedMesh mesh;
  ExecutionContext context({.max_triangles = 1000});
  const auto summary = generate_mesh(request, mesh, context);
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_GT(summary->unrefined.budget, 0u);
  EXPECT_EQ(summary->unrefined.without_exemption(), 0u);
}

TEST(BoundsError, EndsAStreamAfterItsChunksAndIsTheSameOnAnyNumberOfThreads) {
  MeshRequest request = below_precision("1e-4");
  request.leaf_triangles = 100;
  const Outcome one = outcome_of(request);
  const Outcome three = outcome_of(request, 3);
  ASSERT_FALSE(one.summary);
  ASSERT_FALSE(three.summary);
  EXPECT_EQ(one.summary.error().code, ErrorCode::kBoundsNotMet);
  EXPECT_GT(one.mesh.chunks, 64u);
  EXPECT_EQ(one.mesh.chunks, three.mesh.chunks);
  EXPECT_EQ(one.summary.error().message, three.summary.error().message);
}

// What the summary tells if one triangle of two is left bad.
Fragment fragment_with_a_bad_triangle(Badness badness, bool truncated) {
  const ExecutionContext context;
  const Domain domain = *triangulate(square(), context);
  MeshStore mesh = *MeshStore::from(domain, 1000, 2, context);
  const AcuteCorners corners = *AcuteCorners::build(domain, QualityBounds{}, context);
  Slots::of_domain(domain).number_vertices(mesh, 0);
  mesh.triangles[1].set_badness(badness);
  FragmentBuilder<ConstantArea> builder(mesh, domain, corners, ConstantArea(1), false, truncated,
                                        context);
  builder.add_vertices(0, 4);
  builder.add_triangles(0, 2);
  return *builder.finish();
}

TEST(BoundsError, ATriangleThatStreamingLeavesIsNotTakenForTheBudgets) {
  const Fragment left = fragment_with_a_bad_triangle(kSkinny, false);
  EXPECT_EQ(left.unrefined.streaming, 1u);
  EXPECT_EQ(left.unrefined.too_large, 0u);
  EXPECT_EQ(left.unrefined.budget, 0u);
  EXPECT_NEAR(left.unrefined_at.x + left.unrefined_at.y, 1, 0.5);
  EXPECT_EQ(fragment_with_a_bad_triangle(kLarge, false).unrefined.too_large, 1u);

  const Fragment truncated = fragment_with_a_bad_triangle(kSkinny, true);
  EXPECT_EQ(truncated.unrefined.streaming, 0u);
  EXPECT_EQ(truncated.unrefined.budget, 1u);
}

std::string message_of(const Unrefined& unrefined) {
  Summary summary;
  summary.unrefined = unrefined;
  summary.unrefined_at = {0.25, -2};
  const Error error = bounds_error(summary, 20).value_or(Error{});
  EXPECT_EQ(error.at.has_value(), !error.message.empty());
  EXPECT_EQ(error.at.value_or(summary.unrefined_at), summary.unrefined_at);
  return error.message;
}

TEST(BoundsError, TellsTheReasonsApart) {
  EXPECT_EQ(message_of({.small_input_angle = 3, .edge_floor = 2, .budget = 1}), "");
  EXPECT_EQ(message_of({.precision = 12}),
            "12 triangles miss the minimum angle of 20 degrees because double precision ends; the "
            "first is at (0.25, -2); a larger snap merges what lies too near together");
  EXPECT_EQ(message_of({.streaming = 1, .too_large = 1}),
            "1 triangle misses the bound on its area because what is around it had been sent "
            "already; the first is at (0.25, -2)");
  EXPECT_EQ(message_of({.precision = 2, .streaming = 1, .too_large = 1}),
            "3 triangles miss the bound on their area (1) or the minimum angle of 20 degrees "
            "because double precision ends, or because what is around them had been sent already; "
            "the first is at (0.25, -2)");
}

}  // namespace
}  // namespace weft

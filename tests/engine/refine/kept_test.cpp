// SPDX-License-Identifier: Apache-2.0
// Segments that are kept as they are. Every mesh is judged by the independent checker.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "engine/base/arena.h"
#include "tests/engine/domain/arcs/arc_shapes.h"
#include "tests/engine/parallel/parallel.h"
#include "tests/engine/refine/random_pslg.h"
#include "tests/engine/refine/sound.h"

namespace weft {
namespace {

constexpr std::int32_t kRim = 7;

// A square from (-2, -2) to (2, 2) with a hole, a regular polygon of radius 1 with marker kRim.
Pslg square_with_hole(std::uint32_t corners) {
  Pslg pslg;
  add_box(pslg, {-2, -2}, {2, 2});
  const auto first = static_cast<std::uint32_t>(pslg.points.size());
  for (std::uint32_t i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    pslg.points.push_back({std::cos(angle), std::sin(angle)});
    pslg.segments.push_back({first + i, first + (i + 1) % corners, kRim});
  }
  pslg.holes.push_back({0, 0});
  return pslg;
}

std::size_t edges_with(std::int32_t marker, const CollectedMesh& collected) {
  return static_cast<std::size_t>(
      std::count_if(collected.mesh.edges.begin(), collected.mesh.edges.end(),
                    [&](const check::Mesh::Edge& edge) { return edge.marker == marker; }));
}

TEST(Kept, TheEdgesOfAHoleStayWhateverTheSize) {
  for (const double angle : {0.0, 20.0, 30.0, 34.0}) {
    for (const double size : {1.0, 1e-2, 1e-4}) {
      SCOPED_TRACE(std::to_string(angle) + " degrees, size " + std::to_string(size));
      MeshRequest request{.pslg = square_with_hole(100), .size = size, .min_angle_deg = angle};
      request.keep = {kRim};
      const Sound made = sound(request);
      EXPECT_EQ(edges_with(kRim, made.mesh), 100u);
      if (size > 1e-3) EXPECT_EQ(made.summary.unrefined.total(), 0u);
    }
  }
}

TEST(Kept, OtherwiseTheyAreSplit) {
  EXPECT_GT(edges_with(kRim, sound({.pslg = square_with_hole(100), .size = 1e-4}).mesh), 300u);
}

// Far from what is kept the mesh is as fine as asked, and at it as fine as angles allow.
TEST(Kept, TrianglesThatMissTheirSizeAreNearLongSegments) {
  MeshRequest request{.pslg = square_with_hole(6), .size = 1e-3};
  request.keep = {kRim};
  const Sound made = sound(request);
  EXPECT_EQ(edges_with(kRim, made.mesh), 6u);
  EXPECT_GT(made.summary.unrefined.kept, 0u);
  EXPECT_LT(made.summary.unrefined.kept, 200u);
  EXPECT_GT(made.summary.triangles, 11'000u);
  EXPECT_EQ(made.summary.unrefined.total(), made.summary.unrefined.kept);
  const auto& mesh = made.mesh.mesh;
  double farthest = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
    const double area = 0.5 * ((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x));
    if (area > 1.0001e-3)
      farthest = std::max(farthest, std::hypot((p.x + q.x + r.x) / 3, (p.y + q.y + r.y) / 3));
  }
  EXPECT_LT(farthest, 1 + 0.5);  // half of a segment off it, at most
  const Point worst = made.summary.kept_at;
  EXPECT_LT(std::hypot(worst.x, worst.y), 1 + 0.5);
}

TEST(Kept, AShortSegmentBesideLongOnesStays) {
  Pslg pslg;
  add_box(pslg, {0, 0}, {1, 1});
  pslg.points.push_back({0.5, 0.5});
  pslg.points.push_back({0.5, 0.501});
  pslg.segments.push_back({4, 5, kRim});
  for (const auto& keep : {std::vector<std::int32_t>{kRim}, std::vector<std::int32_t>{}}) {
    MeshRequest request{.pslg = pslg};
    request.keep = keep;
    const Sound made = sound(request);
    EXPECT_EQ(edges_with(kRim, made.mesh), 1u);
    EXPECT_LT(made.summary.triangles, 300u);
    if (keep.empty()) EXPECT_EQ(made.summary.edges, 5u);
  }
}

// Between an arc and a chord that is not split, vertices would lie.
TEST(Kept, ArcsAreRefusedAndSplitBesideWhatIsKept) {
  MeshRequest request{.size = 1e-2};
  add_box(request.pslg, {-2, -2}, {2, 2});
  for (Segment& side : request.pslg.segments) side.marker = kRim;
  add_circle(request.pslg, {0, 0}, 1);
  request.keep.emplace();
  const auto refused = mesh_on(nullptr, request);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message,
            "quality.keep keeps straight segments, but segment 4 is an arc");
  request.keep->push_back(kRim);
  const Sound made = sound(request);
  EXPECT_EQ(edges_with(kRim, made.mesh), 4u);
  EXPECT_GT(made.summary.edges, 30u);
  for (std::uint64_t seed = 0; seed < (kSanitized ? 10 : 60); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    MeshRequest random{.pslg = random_arcs(seed), .size = 0.05};
    std::vector<bool> is_arc(random.pslg.segments.size(), false);
    for (const Arc& arc : random.pslg.arcs) is_arc[arc.segment] = true;
    bool any = false;
    for (std::size_t i = 0; i < is_arc.size(); ++i) {
      random.pslg.segments[i].marker = is_arc[i] ? 0 : kRim;
      any |= !is_arc[i];
    }
    if (any) random.keep = {kRim};
    random.sweeps = static_cast<std::uint32_t>(seed % 3);
    sound(random);
  }
}

// Without a bound on angles, points may be placed as near to a segment as they can be.
TEST(Kept, NoTriangleIsFlatWithoutABoundOnAngles) {
  for (std::uint64_t seed = 0; seed < (kSanitized ? 20 : 200); ++seed) {
    for (const Kind& kind : kinds()) {
      SCOPED_TRACE(std::string(kind.name) + ", seed " + std::to_string(seed));
      Random random(seed);
      MeshRequest request{.pslg = kind.generate(random), .min_angle_deg = 0, .leaf_triangles = 50};
      if (seed % 2 == 0) request.size = 0.05;
      request.keep.emplace();
      CollectedMesh mesh;
      const auto summary = mesh_on(nullptr, request, mesh);
      if (summary) ASSERT_EQ(verdict(request, mesh, *summary), "");
    }
  }
}

// Nothing of what is kept makes a run endless, and all else keeps its bounds.
TEST(Kept, RandomDomainsEnd) {
  for (const Kind& kind : kinds()) {
    for (std::uint64_t seed = 0; seed < (kSanitized ? 10 : 60); ++seed) {
      Random random(seed);
      MeshRequest request{.pslg = kind.generate(random)};
      SCOPED_TRACE(std::string(kind.name) + ", seed " + std::to_string(seed));
      for (std::size_t i = 0; i < request.pslg.segments.size(); ++i)
        request.pslg.segments[i].marker = static_cast<std::int32_t>(i % 3);
      if (seed % 2 == 0) request.size = 0.002 + 0.3 * random.unit();
      constexpr double kAngles[] = {0, 20, 25, 30};
      request.min_angle_deg = kAngles[random.below(4)];
      request.sweeps = static_cast<std::uint32_t>(seed % 3);
      request.keep.emplace();
      if (seed % 3 != 0) request.keep->push_back(static_cast<std::int32_t>(seed % 3));
      CollectedMesh mesh;
      const auto summary = mesh_on(nullptr, request, mesh);
      if (!summary) {
        ASSERT_EQ(summary.error().code, ErrorCode::kEmptyDomain) << summary.error().message;
        continue;
      }
      ASSERT_EQ(verdict(request, mesh, *summary), "");
      ASSERT_EQ(summary->unrefined.without_exemption(), 0u);
    }
  }
}

TEST(Kept, MeshesAreTheSameAtAnyNumberOfThreads) {
  MeshRequest request{.pslg = square_with_hole(12),
                      .size = kSanitized ? 1e-3 : 5e-5,
                      .leaf_triangles = kSanitized ? 500.0 : 4000.0};
  request.keep = {kRim};
  CollectedMesh mesh;
  const auto alone = mesh_on(nullptr, request, mesh);
  ASSERT_TRUE(alone);
  EXPECT_EQ(verdict(request, mesh, *alone), "");
  EXPECT_GT(alone->leaves.size(), 10u);
  EXPECT_FALSE(alone->streamed);
  for (const std::uint32_t threads : {2u, 3u, 7u}) {
    Arena arena(threads);
    EXPECT_EQ(outcome(mesh_on(&arena, request)), outcome(alone));
  }
}

TEST(Kept, SegmentsHaveNoLengthOfEdgesAndAreNotSimplified) {
  const auto refusal = [](const MeshRequest& request) {
    const auto made = mesh_on(nullptr, request);
    return made ? "" : made.error().message;
  };
  MeshRequest request{.pslg = square_with_hole(8), .size = 0.1};
  request.keep = {0, kRim, 9};
  EXPECT_EQ(refusal(request),
            "quality.keep.markers[2] is 9, which is the marker of no segment of the domain");
  request.keep = {kRim};
  request.size.at = {{0, 0.5}};
  EXPECT_EQ(refusal(request), "");
  request.size.at.push_back({kRim, 0.1});
  EXPECT_EQ(refusal(request),
            "size.at[1].marker is 7, whose segments quality.keep keeps as they are");
  request.keep->clear();
  EXPECT_EQ(refusal(request),
            "size.at[0].marker is 0, whose segments quality.keep keeps as they are");
  request.size.at.clear();
  request.keep->assign(kMaxKeptMarkers + 1, kRim);
  EXPECT_EQ(refusal(request),
            "quality.keep.markers is 4097 markers; it must be at most 4096, or none: all");
  request.keep->pop_back();
  EXPECT_EQ(refusal(request), "");
  request.simplify = 0.5;
  EXPECT_EQ(refusal(request), "quality.keep keeps segments as they are, but simplify is 0.5");
}

}  // namespace
}  // namespace weft

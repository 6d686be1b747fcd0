// SPDX-License-Identifier: Apache-2.0
// Smoothing: what it gains, and that nothing but the place of vertices changes. That the same
// vertices move at any number of threads is in parallel_test.cpp.
#include "engine/refine/smoothing/smoother.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "engine/refine/storage/vertex_set.h"
#include "tests/engine/domain/shapes.h"
#include "tests/engine/refine/sound.h"
#include "tests/support/floor_plan.h"
#include "tests/support/poly.h"
#include "weft/weft.h"

namespace weft {
namespace {

Sound sound(MeshRequest request, std::optional<std::uint32_t> sweeps) {
  request.sweeps = sweeps;
  return weft::sound(request);
}

MeshRequest cylinder() {
  return {.pslg = read_poly(model("cylinder.poly")),
          .size = "(x>=0 && abs(y)<5) || (x<0 && x^2+y^2<25) ? 1.2e-2 : 1e-1",
          .leaf_triangles = 1'500};
}
MeshRequest key() {
  return {.pslg = read_poly(model("key.poly")), .size = "0.02*abs(y-46)+0.1"};
}
// Of one size, so that it is not refined in stages, in which vertices move, too.
MeshRequest even_key() {
  return {.pslg = read_poly(model("key.poly")), .size = 0.3};
}

TEST(Smoothing, RaisesSmallAnglesAndLowersLargeOnes) {
  for (const MeshRequest& request : {cylinder(), even_key()}) {
    const Summary rough = sound(request, 0).summary;
    const Summary once = sound(request, 1).summary;
    const Summary often = sound(request, 8).summary;
    EXPECT_GT(once.min_angle_p1_deg, rough.min_angle_p1_deg + 1.5);
    EXPECT_GT(often.min_angle_p1_deg, once.min_angle_p1_deg + 0.5);
    EXPECT_LE(once.max_angle_deg, rough.max_angle_deg);
    EXPECT_LT(often.max_angle_deg, rough.max_angle_deg - 2);
    EXPECT_GT(once.mean_quality, rough.mean_quality);
  }
}

TEST(Smoothing, MovesVerticesAndChangesNothingElse) {
  for (const MeshRequest& request : {cylinder(), even_key()}) {
    const Sound rough = sound(request, 0);
    const Sound smooth = sound(request, 3);
    EXPECT_EQ(rough.mesh.mesh.triangles, smooth.mesh.mesh.triangles);
    const std::vector<check::Vec2>& before = rough.mesh.mesh.vertices;
    const std::vector<check::Vec2>& after = smooth.mesh.mesh.vertices;
    ASSERT_EQ(before.size(), after.size());
    std::size_t moved = 0;
    for (std::size_t i = 0; i < before.size(); ++i)
      moved += before[i].x != after[i].x || before[i].y != after[i].y;
    EXPECT_GT(moved, 0u);
    EXPECT_LT(moved, before.size() / 2);
  }
}

TEST(Smoothing, IsDoneTwiceWhereASizeMakesTheTriangles) {
  EXPECT_EQ(sound(key(), std::nullopt).summary.digest, sound(key(), 2).summary.digest);
  EXPECT_NE(sound(key(), std::nullopt).summary.digest, sound(key(), 0).summary.digest);
}

// Of a large mesh. Not judged: the other tests are for that.
TEST(Smoothing, IsLeftOutUnlessAskedForWhereManyLatticesMeet) {
  const auto digest = [](const char* size, std::optional<std::uint32_t> sweeps) {
    const MeshRequest request{.pslg = square(100), .size = size, .sweeps = sweeps};
    CollectedMesh mesh;
    weft::Run run;
    const Result<Summary> summary = stream(request, mesh, run);
    EXPECT_GT(summary.value().triangles, 100'000u);
    return summary.value().digest;
  };
  const char* waves = "0.06*(1.5+sin(x/5)*cos(y/7))";
  EXPECT_EQ(digest(waves, std::nullopt), digest(waves, 0));
  const char* harmonic = "5e-6*((x+20)^2+(y+20)^2)";
  EXPECT_EQ(digest(harmonic, std::nullopt), digest(harmonic, 2));
}

TEST(Smoothing, IsLeftOutUnlessAskedForWhereAnglesOrCircumcentresMakeTheTriangles) {
  MeshRequest no_size = key();
  no_size.size = {};
  MeshRequest circumcentres = key();
  circumcentres.placement = Placement::kCircumcentre;
  for (const MeshRequest& request : {no_size, circumcentres}) {
    const Summary usual = sound(request, std::nullopt).summary;
    EXPECT_EQ(usual.digest, sound(request, 0).summary.digest);
    const Summary asked = sound(request, 4).summary;
    EXPECT_GT(asked.min_angle_p1_deg, usual.min_angle_p1_deg);
    EXPECT_GT(asked.mean_quality, usual.mean_quality);
  }
}

TEST(Smoothing, KeepsTheBoundsOfRegionsAndShortestEdges) {
  MeshRequest request{.pslg = square(10), .size = 1e-2, .min_edge = 0.08};
  request.pslg.points.insert(request.pslg.points.end(), {{3, 0}, {4, 10}});
  request.pslg.segments.push_back({4, 5, 0});
  request.pslg.regions = {{{1, 1}, 1, 4e-3}, {{9, 9}, 2, std::nullopt}};
  EXPECT_GT(sound(request, 6).summary.triangles, 10'000u);
}

// Ends of partitions are beside their walls by what rounding left, and triangles as small as that.
TEST(Smoothing, KeepsAllLawsOfRoundedFloorPlans) {
  constexpr double kOffsets[] = {0, 1e5, 1e6};
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const int decimals = 2 + static_cast<int>(seed % 8);
    MeshRequest request{.pslg = floor_plan({seed, kOffsets[seed % 3], decimals}),
                        .size = 0.1,
                        .min_angle_deg = seed % 2 == 0 ? 20.0 : 33.0,
                        .leaf_triangles = 1'500};
    if (seed % 4 == 0) request.size = {};
    EXPECT_NE(sound(request, 4).summary.digest, sound(request, 0).summary.digest);
  }
}

TEST(VertexSet, HoldsEachVertexOnceUntilItIsCleared) {
  VertexSet set;
  std::set<std::uint32_t> expected;
  std::uint32_t vertex = 1;
  for (int i = 0; i < 20'000; ++i) {
    vertex = vertex * 1664525u + 1013904223u;
    EXPECT_EQ(set.add(vertex >> 18), expected.insert(vertex >> 18).second);
  }
  set.clear();
  EXPECT_TRUE(set.add(*expected.begin()));
  EXPECT_FALSE(set.add(*expected.begin()));
}

}  // namespace
}  // namespace weft

// SPDX-License-Identifier: Apache-2.0
#include "engine/refine/row_filler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/engine.h"
#include "tests/engine/domain/shapes.h"
#include "tests/engine/refine/row_ground.h"
#include "tests/engine/refine/sound.h"

namespace weft {
namespace {

constexpr Box kLeaf{1, 1, 9, 9};

// Fills the leaf, and returns how many vertices that made.
std::uint64_t fill(RowGround& ground) {
  RowFiller<ConstantArea> filler(ground.refinement(), ground.quality, ground.area);
  const std::vector<BadTriangle> bad = ground.queue_bad();
  filler.fill(ground.refiner, ground.slots, ground.ownership, kLeaf, bad);
  return ground.refiner.stats().insertions;
}

// The triangles that there are over those that the leaf will have.
double share(const RowGround& ground) {
  return static_cast<double>(ground.alive()) * RowGround::kBound / (kLeaf.width() * kLeaf.height());
}

TEST(RowFiller, MakesMostOfALeaf) {
  RowGround ground;
  fill(ground);
  EXPECT_GT(share(ground), 0.8);
  ground.expect_sound();
}

TEST(RowFiller, MakesTheQuartersThatAreClear) {
  Pslg pslg = square(10);
  add_segment(pslg, {6.1, 6.2}, {7.3, 6.9});
  RowGround ground(pslg);
  fill(ground);
  EXPECT_GT(share(ground), 0.5);
  EXPECT_LT(share(ground), 0.7);
  ground.expect_sound();
}

TEST(RowFiller, LeavesNothingTooLargeBehindAtAnyAngle) {
  for (const double angle : {0.0, 20.0, 29.5, 29.6, 30.0, 31.0, 31.5}) {
    RowGround ground(square(10), angle);
    fill(ground);
    EXPECT_FALSE(ground.refiner.run());
    ground.expect_sound();
    ground.for_alive(
        [&](std::uint32_t t) { ASSERT_LE(ground.area_of(t), RowGround::kBound) << angle; });
  }
}

TEST(RowFiller, MakesNothingWithoutALattice) {
  RowGround ground(square(10), 33);
  EXPECT_EQ(fill(ground), 0u);
}

TEST(RowFiller, MakesNothingIfTheLatticeIsBelowTheFloorOfEdges) {
  RowGround ground(square(10), 20, 0.999 * RowGround().spacing());
  EXPECT_GT(fill(ground), 1000u);
  RowGround floored(square(10), 20, RowGround().spacing());
  EXPECT_EQ(fill(floored), 0u);
}

TEST(RowFiller, LeavesARegionWithABoundOfItsOwnAlone) {
  Pslg pslg = square(10);
  pslg.regions.push_back({{5, 5}, 1, RowGround::kBound / 2});
  RowGround ground(pslg);
  EXPECT_EQ(fill(ground), 0u);
}

// Points, segments and holes in the midst of a leaf, and what is on the lattice itself.
MeshRequest scattered() {
  MeshRequest request{.pslg = square(10), .size = 1e-3, .leaf_triangles = 4000};
  const double spacing = std::sqrt(lattice_spacing2(1e-3, LatticeShape::for_angle(20)));
  for (int i = 0; i < 12; ++i) {
    const Point p{0.7 + 0.71 * i, 0.4 + 0.83 * ((7 * i) % 11)};
    if (i % 3 == 0) request.pslg.points.push_back(p);
    if (i % 3 == 1) add_segment(request.pslg, p, {p.x + 1e-3, p.y + 2e-3});
    if (i % 3 == 2) {
      add_box(request.pslg, p, {p.x + 0.01, p.y + 0.01});
      request.pslg.holes.push_back({p.x + 0.005, p.y + 0.005});
    }
  }
  const auto rectangle = LatticeRectangle::in({4, 4, 6, 6}, spacing, 1e-4);
  request.pslg.points.push_back(rectangle->at(5, 5));
  return request;
}

TEST(RowFiller, KeepsEveryPointSegmentAndHole) {
  MeshRequest request = scattered();
  for (const double angle : {20.0, 30.0}) {
    request.min_angle_deg = angle;
    const Summary summary = sound(request).summary;
    EXPECT_GT(summary.triangles, 100'000u);
    EXPECT_LE(summary.ideal_ratio, angle == 20 ? 1.06 : 1.1);
    for (const int threads : {2, 3, 7}) {
      Arena arena(threads);
      EXPECT_EQ(outcome(mesh_on(&arena, request)), outcome(summary)) << threads;
    }
  }
}

// A triangle of a row may have three vertices of earlier leaves; then nobody but its own leaf sends
// it (fragment.h).
TEST(RowFiller, LosesNoTriangleBetweenLeaves) {
  for (const double leaf : {300.0, 450.0, 700.0}) {
    const MeshRequest request{.pslg = square(10), .size = 1e-3, .leaf_triangles = leaf};
    EXPECT_GT(sound(request).summary.triangles, 100'000u);
  }
}

}  // namespace
}  // namespace weft

// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/refine/refiner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "engine/engine.h"
#include "tests/domain/shapes.h"
#include "tests/support/collected_mesh.h"

namespace weft {
namespace {

// A square that has been refined to triangles of at most `area`.
struct RefinedSquare {
  explicit RefinedSquare(double area)
      : domain(*triangulate(square(), context)),
        corners(*AcuteCorners::build(domain, context)),
        mesh(*Mesh::from(domain, 1'000'000, 0, context)) {
    refine<OwnsAll>({}, area);
  }

  template <class Ownership>
  std::vector<typename Refiner<Ownership, ConstantArea>::Deferred> refine(Ownership ownership,
                                                                          double area) {
    ConstantArea bound(area);
    Refiner<Ownership, ConstantArea> refiner(mesh, corners, domain.regions,
                                             QualityBounds::from(20, 0, 1e-9),
                                             Order::kLastInFirstOut, bound, 0, context);
    refiner.set_ownership(ownership);
    EXPECT_FALSE(refiner.queue_all());
    EXPECT_FALSE(refiner.run());
    return refiner.deferred();
  }

  double area(const Triangle& t) const {
    const Point a = mesh.vertices[t.vertex[0]];
    const Point b = mesh.vertices[t.vertex[1]];
    const Point c = mesh.vertices[t.vertex[2]];
    return 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
  }

  ExecutionContext context;
  Domain domain;
  AcuteCorners corners;
  Mesh mesh;
};

TEST(Ownership, KeepsATaskFromTouchingWhatItDoesNotOwn) {
  RefinedSquare square(1e-3);
  const OwnsBox left{{-1, -1, 0.5, 2}};
  const auto owned = [&](const Triangle& t) {
    return left.owns(square.mesh.vertices[t.vertex[0]]) &&
           left.owns(square.mesh.vertices[t.vertex[1]]) &&
           left.owns(square.mesh.vertices[t.vertex[2]]);
  };
  const std::vector<Triangle> before(square.mesh.triangles.data(),
                                     square.mesh.triangles.data() + square.mesh.triangle_count);
  const auto deferred = square.refine(left, 1e-5);
  for (std::size_t t = 0; t < before.size(); ++t) {
    if (owned(before[t])) continue;
    EXPECT_EQ(std::memcmp(before[t].vertex, square.mesh.triangles[t].vertex, 12), 0) << t;
    EXPECT_EQ(before[t].flags, square.mesh.triangles[t].flags) << t;
  }
  EXPECT_FALSE(deferred.empty());
}

TEST(Ownership, LeavesOnlyDeferredTrianglesBad) {
  RefinedSquare square(1e-3);
  const OwnsBox left{{-1, -1, 0.5, 2}};
  const auto deferred = square.refine(left, 1e-5);
  std::size_t bad_and_owned = 0;
  for (std::uint32_t t = 0; t < square.mesh.triangle_count; ++t) {
    bool inside = true;
    for (std::uint32_t v : square.mesh.triangles[t].vertex)
      inside = inside && left.owns(square.mesh.vertices[v]);
    bad_and_owned += inside && square.area(square.mesh.triangles[t]) > 1e-5 ? 1 : 0;
  }
  EXPECT_LE(bad_and_owned, deferred.size());
  EXPECT_GT(square.mesh.triangle_count, 40'000u);
}

TEST(Ownership, OfHalvesOneAfterTheOtherAndThenAllLeavesNothingBad) {
  RefinedSquare square(1e-3);
  square.refine(OwnsBox{{-1, -1, 0.5, 2}}, 1e-5);
  square.refine(OwnsBox{{0.5, -1, 2, 2}}, 1e-5);
  EXPECT_TRUE(square.refine(OwnsAll{}, 1e-5).empty());
  for (std::uint32_t t = 0; t < square.mesh.triangle_count; ++t)
    ASSERT_LE(square.area(square.mesh.triangles[t]), 1e-5);
}

TEST(Segments, ThatAlmostCoincideDoNotSplitEachOtherDownToTheFloor) {
  MeshRequest request{.pslg = square(20)};
  add_segment(request.pslg, {1, 1}, {19, 7});
  add_segment(request.pslg, {1, 1}, {10, 4 + 3e-13});
  add_segment(request.pslg, {10, 4 + 3e-13}, {19, 7});
  CollectedMesh mesh;
  ExecutionContext context(Budget{.triangle_limit = 100'000});
  const auto summary = generate_mesh(request, mesh, context);
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_GT(summary->unrefined.edge_floor, 0u);
}

TEST(Cavity, OfThousandsOfTrianglesFits) {
  // The circumcentre's cavity is the whole polygon.
  MeshRequest request;
  std::vector<Point> ring;
  for (int i = 0; i < 5000; ++i) {
    const double angle = 6.283185307179586 * i / 5000;
    ring.push_back({std::cos(angle), std::sin(angle)});
  }
  add_ring(request.pslg, ring);
  request.min_angle_deg = 25;
  CollectedMesh mesh;
  ExecutionContext context;
  const auto summary = generate_mesh(request, mesh, context);
  ASSERT_TRUE(summary);
  EXPECT_EQ(verdict(request, mesh, *summary), "");
}

TEST(BlockStack, GivesBackInReverseAcrossBlocks) {
  BlockStack<std::uint32_t> stack;
  constexpr std::uint32_t kCount = 20'000;
  for (std::uint32_t i = 0; i < kCount; ++i) stack.push(i);
  for (std::uint32_t i = kCount; i-- > 0;) ASSERT_EQ(stack.pop(), i);
  EXPECT_TRUE(stack.empty());
  EXPECT_LT(stack.peak_bytes(), kCount * 4 + (1 << 15));
}

}  // namespace
}  // namespace weft

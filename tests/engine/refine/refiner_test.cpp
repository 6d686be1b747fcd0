// SPDX-License-Identifier: Apache-2.0
#include "engine/refine/refiner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "engine/engine.h"
#include "tests/engine/domain/shapes.h"
#include "tests/support/collected_mesh.h"

namespace weft {
namespace {

constexpr Box kEverywhere{-2, -2, 3, 3};

// A square that has been refined to triangles of at most `area`, by owner 0.
struct RefinedSquare {
  explicit RefinedSquare(double area)
      : domain(*triangulate(square(), context)),
        corners(*AcuteCorners::build(domain, kQuality, context)),
        mesh(*MeshStore::from(domain, 1'000'000, 0, context)),
        slots({Slots::of_domain(domain)}) {
    Refiner<OwnsAll, ConstantArea> refiner(refinement(), kQuality, ConstantArea(area));
    refiner.begin(slots[0], OwnsAll{}, kEverywhere);
    EXPECT_FALSE(refiner.queue_all());
    EXPECT_FALSE(refiner.run());
    EXPECT_TRUE(refiner.deferred().empty());
  }

  RefinementContext refinement() {
    return {mesh, corners, domain.regions, limits, context, 0, 10'000'000};
  }

  // Refines what the box owns, as the next owner; returns what was deferred.
  std::vector<BadTriangle> refine(const Box& box, double area) {
    slots.emplace_back(static_cast<std::uint32_t>(slots.size()));
    Refiner<OwnsBox, ConstantArea> refiner(refinement(), kQuality, ConstantArea(area));
    refiner.begin(slots.back(), OwnsBox{box, box}, box);
    for_alive([&](std::uint32_t t) {
      if (this->area(t) <= area) return;
      mesh.triangles[t].set_badness(kLarge);
      refiner.queue(BadTriangle{t, mesh.triangles[t].vertex[0]});
    });
    EXPECT_FALSE(refiner.run());
    return refiner.deferred();
  }

  // Makes another triangle in a slot, with a vertex of its own first, and queues it as skinny.
  void push_skinny(BadTriangles& bad, std::uint32_t slot, double shortest) {
    Triangle& t = mesh.triangles[slot];
    const std::array<Point, 3> corners{{{0, 0}, {shortest, 0}, {0, 4}}};
    for (std::uint32_t i = 0; i < 3; ++i) t.vertex[i] = slots[0].add_vertex(mesh, corners[i]);
    t.set_badness(kSkinny);
    bad.push(slot, kSkinny);
  }

  template <class F>
  void for_alive(F&& f) const {
    for (const Slots& owned : slots) {
      owned.for_triangles([&](std::uint32_t first, std::uint32_t last) {
        for (std::uint32_t t = first; t < last; ++t) {
          if (!mesh.triangles[t].dead()) f(t);
        }
      });
    }
  }

  bool owns(const Box& box, std::uint32_t t) const {
    const auto& v = mesh.triangles[t].vertex;
    return std::all_of(v, v + 3, [&](std::uint32_t i) {
      return OwnsBox{box, box}.owns(mesh.vertices[i]);
    });
  }

  double area(std::uint32_t t) const {
    const auto& v = mesh.triangles[t].vertex;
    const Point a = mesh.vertices[v[0]];
    const Point b = mesh.vertices[v[1]];
    const Point c = mesh.vertices[v[2]];
    return 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
  }

  inline static const QualityBounds kQuality = QualityBounds::from(20, 0, 1e-9);
  ExecutionContext context;
  EdgeLimits limits;
  Domain domain;
  AcuteCorners corners;
  MeshStore mesh;
  std::vector<Slots> slots;  // by owner
};

constexpr Box kLeft{-1, -1, 0.5, 2};
constexpr Box kRight{0.5, -1, 2, 2};

TEST(Ownership, KeepsATaskFromTouchingWhatItDoesNotOwn) {
  RefinedSquare square(1e-3);
  std::vector<std::pair<std::uint32_t, Triangle>> foreign;
  square.for_alive([&](std::uint32_t t) {
    if (!square.owns(kLeft, t)) foreign.push_back({t, square.mesh.triangles[t]});
  });
  EXPECT_FALSE(square.refine(kLeft, 1e-5).empty());
  for (const auto& [t, before] : foreign) {
    EXPECT_EQ(std::memcmp(before.vertex, square.mesh.triangles[t].vertex, 12), 0) << t;
    EXPECT_EQ(before.segment_bits(), square.mesh.triangles[t].segment_bits()) << t;
    EXPECT_FALSE(square.mesh.triangles[t].dead()) << t;
  }
}

TEST(Ownership, LeavesOnlyDeferredTrianglesBad) {
  RefinedSquare square(1e-3);
  const auto deferred = square.refine(kLeft, 1e-5);
  std::size_t bad_and_owned = 0;
  std::size_t alive = 0;
  square.for_alive([&](std::uint32_t t) {
    ++alive;
    bad_and_owned += square.owns(kLeft, t) && square.area(t) > 1e-5 ? 1 : 0;
  });
  EXPECT_LE(bad_and_owned, deferred.size());
  EXPECT_GT(alive, 40'000u);
}

TEST(Ownership, OfHalvesOneAfterTheOtherAndThenAllLeavesNothingBad) {
  RefinedSquare square(1e-3);
  square.refine(kLeft, 1e-5);
  square.refine(kRight, 1e-5);
  EXPECT_TRUE(square.refine(kEverywhere, 1e-5).empty());
  square.for_alive([&](std::uint32_t t) { ASSERT_LE(square.area(t), 1e-5); });
}

TEST(Slots, AreWrittenByTheirOwnerAlone) {
  RefinedSquare square(1e-3);
  square.refine(kLeft, 1e-5);
  square.refine(kRight, 1e-5);
  square.for_alive([&](std::uint32_t t) {
    const std::uint32_t owner = square.mesh.owner_of_triangle(t);
    bool has_own_vertex = false;
    for (const std::uint32_t v : square.mesh.triangles[t].vertex)
      has_own_vertex |= square.mesh.block_of_vertex(v).owner == owner;
    ASSERT_TRUE(has_own_vertex) << t;
  });
}

TEST(Segments, ThatAlmostCoincideBecomeOne) {
  MeshRequest request{.pslg = square(20)};
  add_segment(request.pslg, {1, 1}, {19, 7});
  add_segment(request.pslg, {1, 1}, {10, 4 + 3e-13});
  add_segment(request.pslg, {10, 4 + 3e-13}, {19, 7});
  CollectedMesh mesh;
  ExecutionContext context;
  const auto summary = generate_mesh(request, mesh, context);
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(summary->unrefined.total(), 0u);
  EXPECT_LT(summary->triangles, 100u);
  EXPECT_EQ(summary->merging.segments, 1u);
  EXPECT_EQ(summary->merging.vanished_faces, 1u);
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

TEST(BadTriangles, ComeWorstFirstAndLastInFirst) {
  RefinedSquare square(1e-2);
  BadTriangles bad(square.mesh);
  const std::vector<std::pair<std::uint32_t, Badness>> pushed = {
      {0, kSkinny}, {1, 7}, {2, 200}, {3, 7}, {4, kSkinny}, {5, 64}};
  for (const auto& [t, badness] : pushed) {
    square.mesh.triangles[t].set_badness(badness);
    bad.push(t, badness);
  }
  square.mesh.triangles[5].set_badness(kGood);
  for (const std::uint32_t t : {2u, 3u, 1u, 4u, 0u, kNone}) EXPECT_EQ(bad.pop(), t);
}

// A triangle of no matter what shape but for its shortest edge.
struct OneTriangle {
  std::uint32_t slot;
  double shortest;
};

TEST(BadTriangles, ThatAreSkinnyComeShortestFirstAndLastInFirst) {
  RefinedSquare square(1e-2);
  BadTriangles bad(square.mesh);
  for (const auto& [slot, shortest] : {OneTriangle{0, 0.5}, {1, 0.25}, {2, 0.5}, {3, 1e-9}}) {
    square.push_skinny(bad, slot, shortest);
  }
  for (const std::uint32_t t : {3u, 1u, 2u, 0u, kNone}) EXPECT_EQ(bad.pop(), t);
}

TEST(BadTriangles, DoNotComeInThePlaceOfOneThatHadTheirSlot) {
  RefinedSquare square(1e-2);
  BadTriangles bad(square.mesh);
  for (const auto& [slot, shortest] : {OneTriangle{0, 1e-6}, {1, 1e-3}, {0, 1}}) {
    square.push_skinny(bad, slot, shortest);
  }
  for (const std::uint32_t t : {1u, 0u, kNone}) EXPECT_EQ(bad.pop(), t);
}

}  // namespace
}  // namespace weft

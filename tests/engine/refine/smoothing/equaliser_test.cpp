// SPDX-License-Identifier: Apache-2.0
// What sweeps do to a mesh that was refined with slack.
#include "engine/refine/smoothing/equaliser.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "engine/domain/domain.h"
#include "engine/refine/acute_corners.h"
#include "engine/refine/edge_limits.h"
#include "engine/refine/ownership.h"
#include "engine/refine/refiner.h"
#include "tests/engine/domain/shapes.h"

namespace weft {
namespace {

// A square of side 10 with triangles of at most 1.3 times 0.05, and no lattice.
struct Slack {
  Slack()
      : domain(*triangulate(pslg(), context)),
        corners(*AcuteCorners::build(domain, quality, context)),
        mesh(*MeshStore::from(domain, 100'000, 0, context)),
        slots(Slots::of_domain(domain)),
        refiner(refinement(), quality, ConstantArea(kArea)) {
    refiner.begin(slots, OwnsAll{}, box);
    refiner.set_stage({1.3, false});
    EXPECT_FALSE(refiner.queue_all());
    EXPECT_FALSE(refiner.run());
  }
  static Pslg pslg() {
    Pslg pslg = square(10);
    pslg.points.insert(pslg.points.end(), {{1, 2.3}, {7.1, 4.4}, {3.3, 8.2}});
    return pslg;
  }
  RefinementContext refinement() {
    return {mesh, corners, domain.regions, limits, context, 0, 100'000};
  }
  // Of the areas over 0.05.
  double variance() const {
    double count = 0, sum = 0, squares = 0;
    for_alive([&](const Triangle& t) {
      const double f = area(t) / kArea;
      ++count;
      sum += f;
      squares += f * f;
    });
    return squares / count - (sum / count) * (sum / count);
  }
  double area(const Triangle& t) const {
    const Point a = mesh.vertices[t.vertex[0]];
    const Point b = mesh.vertices[t.vertex[1]];
    const Point c = mesh.vertices[t.vertex[2]];
    return 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
  }
  template <class F>
  void for_alive(F&& f) const {
    slots.for_triangles([&](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t t = first; t < last; ++t)
        if (!mesh.triangles[t].dead()) f(mesh.triangles[t]);
    });
  }
  // Apexes that lie in the diametral disk of a segment.
  int encroaching() const {
    int count = 0;
    for_alive([&](const Triangle& t) {
      for (std::uint32_t i = 0; i < 3; ++i) {
        if (!t.on_segment(i)) continue;
        const Point p = mesh.vertices[t.vertex[i]];
        const Point a = mesh.vertices[t.vertex[kNext[i]]];
        const Point b = mesh.vertices[t.vertex[kPrevious[i]]];
        count += (a.x - p.x) * (b.x - p.x) + (a.y - p.y) * (b.y - p.y) < 0;
      }
    });
    return count;
  }

  static constexpr double kArea = 0.05;
  const Box box{0, 0, 10, 10};
  ExecutionContext context;
  Domain domain;
  QualityBounds quality = QualityBounds::from(20, 0, 1e-12);
  AcuteCorners corners;
  EdgeLimits limits;
  MeshStore mesh;
  Slots slots;
  Refiner<OwnsAll, ConstantArea> refiner;
};

TEST(Equaliser, MakesTrianglesEquallyLarge) {
  Slack made;
  const double before = made.variance();
  const int encroaching = made.encroaching();
  Equaliser<OwnsAll, ConstantArea> equaliser(made.refinement(), made.quality,
                                             ConstantArea(made.kArea));
  equaliser.begin(OwnsAll{}, made.box, 7, 0);
  EXPECT_FALSE(equaliser.run(made.slots, 1.3, 2));
  EXPECT_LT(made.variance(), 0.5 * before);
  EXPECT_LE(made.encroaching(), encroaching);
  EXPECT_TRUE(equaliser.touched().empty()) << "all are of one owner";
}

// A vertex that is not in the middle of its star, in the diametral disk of a side or of none.
Point place_after_a_sweep(double half_side) {
  Pslg pslg;
  pslg.points = {{-half_side, 0}, {half_side, 0}, {1.4, 1.7}, {0, 2.6}, {-1.4, 1.7}, {0.25, 1.3}};
  for (std::uint32_t i = 0; i < 5; ++i) pslg.segments.push_back({i, (i + 1) % 5, 0});
  ExecutionContext context;
  const Domain domain = *triangulate(pslg, context);
  const QualityBounds quality = QualityBounds::from(10, 0, 1e-12);
  const AcuteCorners corners = *AcuteCorners::build(domain, quality, context);
  const EdgeLimits limits;
  MeshStore mesh = *MeshStore::from(domain, 1000, 0, context);
  Equaliser<OwnsAll, ConstantArea> equaliser({mesh, corners, domain.regions, limits, context, 0, 9},
                                             quality, ConstantArea(2));
  const auto free = static_cast<std::uint32_t>(
      std::find(domain.input_point.begin(), domain.input_point.end(), 5U) -
      domain.input_point.begin());
  EXPECT_EQ(free + 1, domain.vertices.size()) << "or the corners would move, too";
  equaliser.begin(OwnsAll{}, {-2, 0, 2, 3}, free, 0);
  EXPECT_FALSE(equaliser.run(Slots::of_domain(domain), 1.3, 1));
  return mesh.vertices[free];
}

TEST(Equaliser, KeepsVerticesOutOfTheDiametralDisksOfSegments) {
  EXPECT_FALSE(place_after_a_sweep(0.8) == (Point{0.25, 1.3}));
  EXPECT_EQ(place_after_a_sweep(1.5), (Point{0.25, 1.3}));
}

TEST(Equaliser, LeavesNothingTooLargeForTheNextStageToMiss) {
  Slack made;
  Equaliser<OwnsAll, ConstantArea> equaliser(made.refinement(), made.quality,
                                             ConstantArea(made.kArea));
  equaliser.begin(OwnsAll{}, made.box, 7, 0);
  EXPECT_FALSE(equaliser.run(made.slots, 1.3, 2));
  made.refiner.begin_stage({}, equaliser.touched());
  EXPECT_FALSE(made.refiner.run());
  made.for_alive([&](const Triangle& t) { EXPECT_LE(made.area(t), made.kArea); });
}

TEST(Equaliser, NamesTheTrianglesOfOtherOwnersThatItChanges) {
  Slack made;
  // Half of the blocks are those of somebody else now.
  for (std::uint32_t block = 0; block * MeshStore::kTriangleBlock < made.slots.triangle_slots();
       block += 2)
    made.mesh.triangle_owner[block] = 7;
  std::vector<Point> before(made.mesh.vertices.data(), made.mesh.vertices.data() + 100'000);
  Equaliser<OwnsAll, ConstantArea> equaliser(made.refinement(), made.quality,
                                             ConstantArea(made.kArea));
  equaliser.begin(OwnsAll{}, made.box, 7, 0);
  EXPECT_FALSE(equaliser.run(made.slots, 1.3, 1));
  const std::vector<std::uint32_t>& touched = equaliser.touched();
  made.slots.for_triangles([&](std::uint32_t first, std::uint32_t last) {
    for (std::uint32_t t = first; t < last; ++t) {
      const Triangle& triangle = made.mesh.triangles[t];
      if (triangle.dead() || made.mesh.owner_of_triangle(t) != 7) continue;
      const bool changed = std::any_of(triangle.vertex, triangle.vertex + 3, [&](std::uint32_t v) {
        return !(made.mesh.vertices[v] == before[v]);
      });
      EXPECT_EQ(changed, std::find(touched.begin(), touched.end(), t) != touched.end());
    }
  });
}

}  // namespace
}  // namespace weft

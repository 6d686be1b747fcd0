// SPDX-License-Identifier: Apache-2.0
// What a move of a vertex must keep.
#include "engine/refine/smoothing/vertex_star.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "engine/domain/domain.h"
#include "engine/refine/acute_corners.h"
#include "engine/refine/edge_limits.h"
#include "engine/refine/ownership.h"
#include "tests/engine/domain/shapes.h"

namespace weft {
namespace {

// An octagon around (2, 2), which may move; its corners are 2 away.
struct Middle {
  explicit Middle(double area, double angle = 20)
      : domain(*triangulate(pslg(), context)),
        quality(QualityBounds::from(angle, 0, 1e-12)),
        corners(*AcuteCorners::build(domain, quality, context)),
        mesh(*MeshStore::from(domain, 1000, 0, context)),
        star({mesh, corners, domain.regions, limits, context, 0, 1000}, quality,
             ConstantArea(area)) {
    star.begin(OwnsAll{}, {0, 0, 4, 4}, 0, 0);
    for (std::uint32_t t = 0; t < domain.triangles.size(); ++t) {
      for (const std::uint32_t v : mesh.triangles[t].vertex)
        if (mesh.vertices[v] == Point{2, 2}) corner = {t, v};
    }
    EXPECT_TRUE(star.find(corner));
    EXPECT_EQ(star.size(), 8U);
  }
  static Pslg pslg() {
    Pslg pslg;
    for (std::uint32_t i = 0; i < 8; ++i) {
      const double angle = std::numbers::pi * (2 * i + 1) / 8;
      pslg.points.push_back({2 + 2 * std::cos(angle), 2 + 2 * std::sin(angle)});
      pslg.segments.push_back({i, (i + 1) % 8, 0});
    }
    pslg.points.push_back({2, 2});
    return pslg;
  }
  Point place() const { return mesh.vertices[corner.vertex]; }

  ExecutionContext context;
  Domain domain;
  QualityBounds quality;
  AcuteCorners corners;
  EdgeLimits limits;
  MeshStore mesh;
  VertexStar<OwnsAll, ConstantArea> star;
  VertexStar<OwnsAll, ConstantArea>::Corner corner{};
};

TEST(VertexStar, MovesWithinTheBounds) {
  Middle middle(8);
  EXPECT_TRUE(middle.star.move({2.1, 2.2}));
  EXPECT_EQ(middle.place(), (Point{2.1, 2.2}));
}

TEST(VertexStar, StaysWhereAMoveWouldMakeATriangleTooLarge) {
  Middle middle(1.5);
  EXPECT_FALSE(middle.star.move({2.2, 2}));
  EXPECT_EQ(middle.place(), (Point{2, 2}));
  EXPECT_TRUE(middle.star.move({2.04, 2}));
}

TEST(VertexStar, TakesBoundsThatAreGiven) {
  Middle middle(1.5);
  const std::vector<double> doubled(8, 4);
  EXPECT_TRUE(middle.star.move({2.2, 2}, doubled.data()));
}

TEST(VertexStar, StaysWhereAnAngleWouldBeTooSmall) {
  Middle middle(8, 36);
  EXPECT_FALSE(middle.star.move({2.7, 2}));
  EXPECT_TRUE(middle.star.move({2.1, 2}));
}

TEST(VertexStar, KnowsTheDiametralDisksOfSegments) {
  const Middle middle(8);
  EXPECT_FALSE(middle.star.encroaches({2, 2}));
  EXPECT_FALSE(middle.star.encroaches({2.5, 2.5}));
  EXPECT_TRUE(middle.star.encroaches({2, 0.5}));
  EXPECT_TRUE(middle.star.encroaches({3.9, 2}));
}

}  // namespace
}  // namespace weft

// SPDX-License-Identifier: Apache-2.0
#include "checker/geometry/arrangement.h"
#include "tests/support/paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>

namespace weft::check {
namespace {

struct Pslg {
  std::vector<Vec2> points;
  std::vector<SegmentEnds> segments;

  std::uint32_t point(Vec2 p) {
    points.push_back(p);
    return static_cast<std::uint32_t>(points.size() - 1);
  }
  Pslg& line(Vec2 p, Vec2 q) {
    const std::uint32_t a = point(p);
    segments.push_back({a, point(q)});
    return *this;
  }
  Pslg& box(double low, double high) {
    return line({low, low}, {high, low})
        .line({high, low}, {high, high})
        .line({high, high}, {low, high})
        .line({low, high}, {low, low});
  }
  Arrangement arrange() const {
    return Arrangement(points, segments, find_contacts(points, segments, 1u << 20));
  }
};

std::vector<double> areas(const Arrangement& arrangement) {
  std::vector<double> result;
  for (std::size_t f = 1; f < arrangement.faces().size(); ++f)
    result.push_back(arrangement.faces()[f].area);
  std::sort(result.begin(), result.end());
  return result;
}

TEST(CheckersArrangement, OfABoxHasOneFace) {
  const Arrangement box = Pslg().box(0, 2).arrange();
  EXPECT_EQ(box.vertices().size(), 4u);
  EXPECT_EQ(box.edges().size(), 4u);
  EXPECT_EQ(areas(box), std::vector<double>{4});
  EXPECT_EQ(box.faces()[0].area, -4);
  EXPECT_EQ(box.faces()[1].perimeter, 8);
}

TEST(CheckersArrangement, OfNothingHasTheUnboundedFace) {
  const Arrangement nothing = Pslg().arrange();
  EXPECT_EQ(nothing.faces().size(), 1u);
  EXPECT_EQ(nothing.locate({0, 0}).face, 0u);
}

TEST(CheckersArrangement, CutsCrossingSegments) {
  const Arrangement cross = Pslg().box(0, 2).line({0, 0}, {2, 2}).line({0, 2}, {2, 0}).arrange();
  EXPECT_EQ(cross.vertices().size(), 5u);
  EXPECT_EQ(cross.edges().size(), 8u);
  EXPECT_EQ(areas(cross), (std::vector<double>{1, 1, 1, 1}));
}

TEST(CheckersArrangement, CutsAtCrossingsThatNoDoubleHolds) {
  // The crossing is at (1/3, 1/3).
  const Arrangement cross = Pslg()
                                .line({0, 0}, {1, 1})
                                .line({0, 0.5}, {1, 0})
                                .line({0, 0}, {0, 0.5})
                                .line({1, 0}, {1, 1})
                                .arrange();
  const std::vector<double> found = areas(cross);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(found[0], 1.0 / 12, 1e-15);
  EXPECT_NEAR(found[1], 1.0 / 3, 1e-15);
}

TEST(CheckersArrangement, MakesOneVertexWhereThreeSegmentsMeet) {
  // All pass through (1/3, 1/3), no end of any.
  const Arrangement star =
      Pslg().line({0, 0}, {1, 1}).line({0, 0.5}, {1, 0}).line({0.5, 0}, {0, 1}).arrange();
  EXPECT_EQ(star.vertices().size(), 7u);
  EXPECT_EQ(star.edges().size(), 6u);
}

TEST(CheckersArrangement, TellsCrossingsApartThatRoundToOneDouble) {
  // Two steep lines 2^-60 apart, crossed by a level one: doubles cannot tell the crossings apart.
  const double tiny = 0x1p-60;
  const Arrangement lines = Pslg()
                                .line({1, 0}, {2, 1})
                                .line({1, tiny}, {2, 1.5})
                                .line({0, 0x1p-61}, {3, 0x1p-61})
                                .arrange();
  EXPECT_EQ(lines.vertices().size(), 7u);
}

TEST(CheckersArrangement, MergesSegmentsThatOverlap) {
  const Arrangement overlap = Pslg().line({0, 0}, {3, 0}).line({2, 0}, {5, 0}).arrange();
  EXPECT_EQ(overlap.vertices().size(), 4u);
  ASSERT_EQ(overlap.edges().size(), 3u);
  EXPECT_EQ(overlap.covers(0).size(), 1u);
  EXPECT_EQ(overlap.covers(1).size(), 2u);
  EXPECT_EQ(overlap.edges_of(0).size(), 2u);
  EXPECT_EQ(overlap.edges_of(1).size(), 2u);
}

TEST(CheckersArrangement, CountsCoincidentSegments) {
  const Arrangement twice = Pslg().line({0, 0}, {1, 2}).line({1, 2}, {0, 0}).arrange();
  ASSERT_EQ(twice.edges().size(), 1u);
  EXPECT_EQ(twice.covers(0).size(), 2u);
}

TEST(CheckersArrangement, CutsASegmentWhereAnotherEnds) {
  const Arrangement tee = Pslg().box(0, 2).line({1, 0}, {1, 2}).arrange();
  EXPECT_EQ(tee.edges().size(), 7u);
  EXPECT_EQ(areas(tee), (std::vector<double>{2, 2}));
}

TEST(CheckersArrangement, KeepsTheSameFaceAroundADanglingSegment) {
  const Arrangement dangling = Pslg().box(0, 4).line({0, 0}, {1, 2}).line({2, 1}, {3, 1}).arrange();
  EXPECT_EQ(areas(dangling), std::vector<double>{16});
  for (std::uint32_t e = 0; e < dangling.edges().size(); ++e) {
    const bool on_box = dangling.covers(e)[0] < 4;
    EXPECT_EQ(dangling.face(2 * e) == dangling.face(2 * e + 1), !on_box);
  }
}

TEST(CheckersArrangement, NestsComponents) {
  const Arrangement nested = Pslg().box(0, 10).box(1, 9).box(2, 3).box(4, 8).box(5, 6).arrange();
  EXPECT_EQ(areas(nested), (std::vector<double>{1, 1, 15, 36, 47}));
}

TEST(CheckersArrangement, PutsComponentsBesideEachOther) {
  const Arrangement apart = Pslg().box(0, 1).box(2, 3).box(-5, -3).arrange();
  EXPECT_EQ(areas(apart), (std::vector<double>{1, 1, 4}));
  EXPECT_EQ(apart.faces()[0].area, -6);
}

TEST(CheckersArrangement, LocatesPoints) {
  const Arrangement nested = Pslg().box(0, 10).box(4, 6).arrange();
  const auto area_at = [&](Vec2 p) { return nested.faces()[nested.locate(p).face].area; };
  EXPECT_EQ(area_at({5, 5}), 4);
  EXPECT_EQ(area_at({1, 5}), 96);
  EXPECT_EQ(area_at({9, 5}), 96);
  EXPECT_EQ(nested.locate({-1, 5}).face, 0u);
  EXPECT_EQ(nested.locate({11, 5}).face, 0u);
}

TEST(CheckersArrangement, LocatesPointsAtTheHeightOfVertices) {
  const Arrangement nested = Pslg().box(0, 10).box(4, 6).arrange();
  const auto area_at = [&](Vec2 p) { return nested.faces()[nested.locate(p).face].area; };
  EXPECT_EQ(area_at({7, 4}), 96);
  EXPECT_EQ(area_at({7, 6}), 96);
  EXPECT_EQ(area_at({1, 4}), 96);
  EXPECT_EQ(nested.locate({11, 0}).face, 0u);
  EXPECT_EQ(nested.locate({11, 10}).face, 0u);
}

TEST(CheckersArrangement, TellsThatAPointLiesOnASegment) {
  const Arrangement box = Pslg().box(0, 2).line({0, 0}, {2, 2}).arrange();
  EXPECT_TRUE(box.locate({1, 0}).edge);
  EXPECT_TRUE(box.locate({0, 0}).edge);
  EXPECT_TRUE(box.locate({2, 2}).edge);
  EXPECT_TRUE(box.locate({2, 1}).edge);
  EXPECT_TRUE(box.locate({0.7, 0.7}).edge);
  EXPECT_FALSE(box.locate({0.7, std::nextafter(0.7, 1)}).edge);
  EXPECT_FALSE(box.locate({3, 3}).edge);
  EXPECT_FALSE(box.locate({3, 0}).edge);
}

TEST(CheckersArrangement, LocatesBetweenCrossingsThatAlmostCoincide) {
  // Two lines that cross at (1/3, 1/3); points just beside the crossing, in each of four faces.
  const Arrangement cross =
      Pslg().box(-1, 2).line({-1, -1}, {2, 2}).line({-1, 1}, {2, -0.5}).arrange();
  const double third = 1.0 / 3, step = 0x1p-40;
  std::vector<std::uint32_t> faces;
  for (const Vec2 p : {Vec2{third + step, third}, Vec2{third - step, third},
                       Vec2{third, third + step}, Vec2{third, third - step}})
    faces.push_back(cross.locate(p).face);
  std::sort(faces.begin(), faces.end());
  EXPECT_EQ(faces, (std::vector<std::uint32_t>{faces[0], faces[1], faces[2], faces[3]}));
  EXPECT_EQ(std::unique(faces.begin(), faces.end()), faces.end());
}

TEST(CheckersArrangement, ObeysEulersFormulaOnRandomSegments) {
  std::mt19937_64 random(4);
  for (int round = 0; round < 20; ++round) {
    // A coarse grid of ends makes overlaps, touches and common crossings frequent.
    std::uniform_int_distribution<int> place(0, 6 + round);
    Pslg pslg;
    for (int i = 0; i < 40; ++i) {
      const Vec2 p{1.0 * place(random), 1.0 * place(random)};
      const Vec2 q{1.0 * place(random), 1.0 * place(random)};
      if (!(p == q)) pslg.line(p, q);
    }
    const Arrangement arrangement = pslg.arrange();
    const auto v = static_cast<int>(arrangement.vertices().size());
    const auto e = static_cast<int>(arrangement.edges().size());
    const auto f = static_cast<int>(arrangement.faces().size());
    std::vector<int> parent(static_cast<std::size_t>(v));
    for (int i = 0; i < v; ++i) parent[static_cast<std::size_t>(i)] = i;
    const std::function<int(int)> root = [&](int i) {
      return parent[static_cast<std::size_t>(i)] == i ? i
                                                      : root(parent[static_cast<std::size_t>(i)]);
    };
    int components = v;
    for (const Arrangement::Edge& edge : arrangement.edges()) {
      const int a = root(static_cast<int>(edge.u)), b = root(static_cast<int>(edge.v));
      if (a == b) continue;
      parent[static_cast<std::size_t>(a)] = b;
      --components;
    }
    EXPECT_EQ(v - e + f, 1 + components);
    double total = 0;
    for (const double area : areas(arrangement)) {
      EXPECT_GT(area, 0);
      total += area;
    }
    EXPECT_NEAR(total, -arrangement.faces()[0].area, 1e-9);
  }
}

TEST(CheckersArrangement, AgreesWithParityOnRandomPolygons) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(0, 1);
  Pslg pslg;
  std::vector<Vec2> ring;
  for (int i = 0; i < 30; ++i) ring.push_back({place(random), place(random)});
  for (std::size_t i = 0; i < ring.size(); ++i) pslg.line(ring[i], ring[(i + 1) % ring.size()]);
  const Arrangement arrangement = pslg.arrange();
  // Crossing numbers of points of one face have one parity.
  std::vector<int> parity(arrangement.faces().size(), -1);
  parity[0] = 0;
  for (int k = 0; k < 2000; ++k) {
    const Vec2 p{place(random), place(random)};
    int crossings = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec2 a = ring[i], b = ring[(i + 1) % ring.size()];
      if ((a.y > p.y) != (b.y > p.y) && p.x > a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x))
        ++crossings;
    }
    int& expected = parity[arrangement.locate(p).face];
    if (expected < 0) expected = crossings % 2;
    EXPECT_EQ(expected, crossings % 2);
  }
}

TEST(Contacts, StopsAtItsLimit) {
  Pslg grid;
  for (int i = 0; i < 50; ++i) {
    grid.line({-1, 1.0 * i}, {50, 1.0 * i});
    grid.line({1.0 * i, -1}, {1.0 * i, 50});
  }
  EXPECT_FALSE(find_contacts(grid.points, grid.segments, 100).complete);
  const Contacts all = find_contacts(grid.points, grid.segments, 10000);
  EXPECT_TRUE(all.complete);
  EXPECT_EQ(all.crossings.size(), 2500u);
}

TEST(CheckersArrangement, OfACoastlineIsThatOfItsRings) {
  std::ifstream file(std::string(weft::testing::kModels) + "/us-east-coast.poly");
  std::string comment;
  std::getline(file, comment);
  std::size_t count = 0;
  int skip = 0;
  file >> count >> skip >> skip >> skip;
  Pslg coast;
  for (std::size_t i = 0; i < count; ++i) {
    Vec2 p;
    file >> skip >> p.x >> p.y;
    coast.point(p);
  }
  file >> count >> skip;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t a = 0, b = 0;
    std::string rest;
    file >> skip >> a >> b;
    std::getline(file, rest);
    coast.segments.push_back({a - 1, b - 1});
  }
  ASSERT_TRUE(file);
  const Arrangement arrangement = coast.arrange();
  // Rings that do not touch: as many edges as vertices, and a face for each ring.
  EXPECT_EQ(arrangement.edges().size(), arrangement.vertices().size());
  EXPECT_GT(arrangement.faces().size(), 10u);
  EXPECT_NEAR(arrangement.faces()[0].area, -400, 200);
}

}  // namespace
}  // namespace weft::check

// SPDX-License-Identifier: Apache-2.0
// The cavity against its definition: the faces that `conflicts` names, around them a closed ring.
#include "engine/domain/triangulation/small_cavity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "engine/domain/triangulation/triangulation.h"
#include "engine/domain/validate.h"

namespace weft {
namespace {

struct Built {
  explicit Built(const std::vector<Point>& input) {
    const Span span = spanning_points(input, poller);
    t.build(input, span.point[0], span.point[1], span.point[2]);
    for (std::uint32_t v = 0; v < t.vertices(); ++v) points.push_back(t.at(v));
    for (std::uint32_t f = 0; f < t.faces(); ++f) {
      Face face{};
      for (int i = 0; i < 3; ++i) {
        const Triangulation::Edge across = t.mirror({f, i});
        face.vertex[i] = t.vertex(f, i);
        face.neighbor[i] = across.face << 2 | static_cast<std::uint32_t>(across.i);
      }
      faces.push_back(face);
    }
  }

  std::set<std::uint32_t> in_conflict(Point p) const {
    std::set<std::uint32_t> result;
    for (std::uint32_t f = 0; f < faces.size(); ++f)
      if (conflicts(faces[f], points.data(), p)) result.insert(f);
    return result;
  }
  bool is_infinite(std::uint32_t face) const { return t.is_infinite(face); }

  const ExecutionContext context;
  StopPoller poller{context};
  Triangulation t{poller};
  std::vector<Point> points;
  std::vector<Face> faces;
};

// Finds the cavity of p from each of its faces. Returns whether it was small and off the hull.
bool expect_cavity(const Built& built, Point p) {
  const std::set<std::uint32_t> expected = built.in_conflict(p);
  const bool is_at_hull = std::any_of(expected.begin(), expected.end(),
                                      [&](std::uint32_t f) { return built.is_infinite(f); });
  const bool is_small = expected.size() <= SmallCavity::kMaxFaces && !is_at_hull;
  for (const std::uint32_t first : expected) {
    SmallCavity cavity;
    EXPECT_EQ(cavity.find(built.faces.data(), built.points.data(), p, first), is_small);
    if (!is_small) continue;
    EXPECT_EQ(cavity.faces()[0], first);
    EXPECT_EQ(std::set(cavity.faces(), cavity.faces() + cavity.size()), expected);
    EXPECT_EQ(cavity.size(), expected.size());
    const Border* const border = cavity.border();
    double nearest2 = INFINITY;
    for (std::uint32_t k = 0; k < cavity.size() + 2; ++k) {
      const Face& outside = built.faces[border[k].outside >> 2];
      const int i = static_cast<int>(border[k].outside & 3);
      EXPECT_EQ(expected.count(border[k].outside >> 2), 0u);
      EXPECT_EQ(outside.vertex[cw(i)], border[k].from);
      EXPECT_EQ(outside.vertex[ccw(i)], border[k + 1].from);
      const Point from = built.points[border[k].from];
      nearest2 =
          std::min(nearest2, (from.x - p.x) * (from.x - p.x) + (from.y - p.y) * (from.y - p.y));
    }
    EXPECT_EQ(cavity.nearest2(), nearest2);
  }
  return is_small;
}

double uniform(std::mt19937& random) {
  return random() / 4294967296.0;
}

TEST(SmallCavity, IsWhatConflictsAroundRandomPoints) {
  std::mt19937 random(7);
  std::vector<Point> points;
  for (int i = 0; i < 300; ++i) points.push_back({uniform(random), uniform(random)});
  const Built built(points);
  int small = 0;
  for (int i = 0; i < 200; ++i)
    small += expect_cavity(built, {1.2 * uniform(random) - 0.1, 1.2 * uniform(random) - 0.1});
  EXPECT_GT(small, 100);
  EXPECT_LT(small, 200);  // some are outside
}

// Four points on each circle: only the perturbation tells the faces in conflict.
TEST(SmallCavity, DecidesTiesExactlyOnAGrid) {
  for (const Point corner : {Point{0, 0}, Point{1e6, -1e6}}) {
    std::vector<Point> points;
    for (int y = 0; y < 12; ++y)
      for (int x = 0; x < 12; ++x)
        if ((x + y) % 3 != 0) points.push_back({corner.x + x / 8.0, corner.y + y / 8.0});
    const Built built(points);
    for (int y = 0; y < 12; ++y)
      for (int x = 0; x < 12; ++x)
        if ((x + y) % 3 == 0) expect_cavity(built, {corner.x + x / 8.0, corner.y + y / 8.0});
  }
}

// Products of differences of 1e-160 underflow.
TEST(SmallCavity, DecidesWhatUnderflows) {
  std::vector<Point> points;
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 6; ++x) points.push_back({x * 1e-80, y * 1e-80});
  const Built built(points);
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 5; ++x) expect_cavity(built, {(x + 0.5) * 1e-80, (y + 0.25) * 1e-80});
}

TEST(SmallCavity, LeavesLargeOnesToTheGeneralWay) {
  std::vector<Point> points{{-2, -2}, {2, -2}, {2, 2}, {-2, 2}};
  constexpr int kAround = SmallCavity::kMaxFaces + 20;
  for (int i = 0; i < kAround; ++i) {
    const double angle = 6.283185307179586 * i / kAround;
    points.push_back({std::cos(angle), std::sin(angle)});
  }
  const Built built(points);
  EXPECT_GT(built.in_conflict({0.001, 0.0005}).size(), SmallCavity::kMaxFaces);
  EXPECT_FALSE(expect_cavity(built, {0.001, 0.0005}));
}

}  // namespace
}  // namespace weft

// SPDX-License-Identifier: Apache-2.0
// Input that no sound program writes: it is a violation, and nothing worse.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/checker/lattice.h"

namespace weft::check::testing {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Hostile, NothingAtAllIsAViolation) {
  EXPECT_FALSE(check({}, {}).ok());
}

TEST(Hostile, BadDomainsAreViolations) {
  const auto refused = [](const std::function<void(Domain&)>& spoil) {
    Problem problem = block(3);
    spoil(problem.domain);
    return problem.check().total(Rule::kDomain) > 0;
  };
  EXPECT_FALSE(refused([](Domain&) {}));
  EXPECT_TRUE(refused([](Domain& d) { d.segments[1] = {0, 99}; }));
  EXPECT_TRUE(refused([](Domain& d) { d.segments[1] = {4000000000u, 0}; }));
  EXPECT_TRUE(refused([](Domain& d) { d.points[1].x = std::nan(""); }));
  EXPECT_TRUE(refused([](Domain& d) { d.points[1].y = -kInfinity; }));
  EXPECT_TRUE(refused([](Domain& d) { d.points[1].y = 1e200; }));
  EXPECT_TRUE(refused([](Domain& d) { d.markers.pop_back(); }));
  EXPECT_FALSE(refused([](Domain& d) { d.arcs = {{0, 0}, {1, 1e3}, {2, -1e-300}}; }));
  EXPECT_TRUE(refused([](Domain& d) { d.arcs = {{4, 1}}; }));
  EXPECT_TRUE(refused([](Domain& d) { d.arcs = {{0, 1}, {0, 0.5}}; }));
  EXPECT_TRUE(refused([](Domain& d) { d.arcs = {{0, kInfinity}}; }));
  EXPECT_TRUE(refused([](Domain& d) { d.arcs = {{0, -1e7}}; }));
  EXPECT_TRUE(refused([](Domain& d) { d.arcs = {{0, std::nan("")}}; }));
  EXPECT_TRUE(refused([](Domain& d) {
    d.segments[0][1] = d.segments[0][0];
    d.arcs = {{0, 1}};
  }));
  EXPECT_TRUE(refused([](Domain& d) { d.holes.push_back({kInfinity, 0}); }));
  EXPECT_TRUE(refused([](Domain& d) { d.regions.push_back({{std::nan(""), 0}, 1, 1}); }));
  EXPECT_TRUE(refused([](Domain& d) { d.regions.push_back({{1, 0.5}, 1, 0}); }));
  EXPECT_TRUE(refused([](Domain& d) { d.regions.push_back({{1, 0.5}, 1, std::nan("")}); }));
}

TEST(Hostile, ManyCrossingsAreRefused) {
  Problem problem = block(1);
  Domain& domain = problem.domain;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const auto first = static_cast<std::uint32_t>(domain.points.size());
    domain.points.push_back({-1.0, i + 0.5});
    domain.points.push_back({4000.0, i + 0.25});
    domain.points.push_back({i + 0.5, -1.0});
    domain.points.push_back({i + 0.25, 4000.0});
    domain.segments.push_back({first, first + 1});
    domain.segments.push_back({first + 2, first + 3});
  }
  domain.markers.clear();
  EXPECT_GT(problem.check().total(Rule::kDomain), 0u);
}

TEST(Hostile, RandomIndicesAreViolations) {
  std::mt19937 random(6);
  for (int round = 0; round < 200; ++round) {
    Problem problem = block(3);
    for (auto& corners : problem.mesh.triangles)
      for (std::uint32_t& corner : corners)
        corner = static_cast<std::uint32_t>(random() % (round % 2 == 0 ? 16 : 17));
    EXPECT_FALSE(problem.check().ok());
  }
}

TEST(Hostile, RandomCoordinatesAreViolations) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> exponent(-160, 160);
  for (int round = 0; round < 200; ++round) {
    Problem problem = block(2);
    for (Vec2& p : problem.mesh.vertices)
      p = {std::pow(10, exponent(random)), -std::pow(10, exponent(random))};
    EXPECT_FALSE(problem.check().ok());
  }
}

TEST(Hostile, RandomListedEdgesAreViolations) {
  std::mt19937 random(8);
  for (int round = 0; round < 200; ++round) {
    Problem problem = block(3);
    for (Mesh::Edge& edge : problem.mesh.edges) {
      edge.a = random() % 16;
      edge.b = random() % 16;
    }
    EXPECT_FALSE(problem.check().ok());
  }
}

TEST(Hostile, ExtremeScalesAreJudgedLikeAnyOther) {
  for (const int exponent : {-330, -100, 100, 330}) {
    Problem problem = block_with_hole();
    const auto scale = [&](Vec2& p) { p = {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent)}; };
    for (Vec2& p : problem.domain.points) scale(p);
    for (Vec2& p : problem.domain.holes) scale(p);
    for (Vec2& p : problem.mesh.vertices) scale(p);
    problem.requirements.max_area = std::nullopt;
    EXPECT_TRUE(problem.check().ok()) << exponent << "\n" << to_text(problem.check());
  }
}

TEST(Hostile, ALongExpressionIsRefused) {
  Problem problem = block(1);
  problem.requirements.size = std::string(100000, '(');
  EXPECT_EQ(violated(problem.check()), std::set<Rule>{Rule::kSize});
}

}  // namespace
}  // namespace weft::check::testing

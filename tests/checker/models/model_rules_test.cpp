// SPDX-License-Identifier: Apache-2.0
#include "checker/models/model_rules.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace weft::check {
namespace {

using Totals = std::map<std::string, std::uint64_t>;

Totals totals(const ModelReport& report) {
  Totals found;
  for (std::size_t r = 0; r < kModelRules; ++r)
    if (report.totals[r] > 0)
      found[std::string(model_rule_name(static_cast<ModelRule>(r)))] = report.totals[r];
  return found;
}
Totals found(const Mesh& mesh, std::vector<std::int32_t> open = {}) {
  return totals(judge_for_models({.mesh = mesh, .open_markers = open}));
}

// Unit squares, each of two triangles, that meet in its corner at the lower right.
struct Squares {
  Mesh mesh;

  std::uint32_t vertex(double x, double y) {
    const auto [found, is_new] =
        number.try_emplace({x, y}, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back({x, y});
    return found->second;
  }
  Squares& add(double x, double y) {
    const auto a = vertex(x, y), b = vertex(x + 1, y);
    const auto c = vertex(x + 1, y + 1), d = vertex(x, y + 1);
    mesh.triangles.push_back({a, b, d});
    mesh.triangles.push_back({b, c, d});
    return *this;
  }
  // Of columns by rows.
  Squares& block(int columns, int rows, double x = 0, double y = 0) {
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) add(x + i, y + j);
    return *this;
  }
  Squares& mark(std::vector<Vec2> line, std::int32_t marker) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i)
      mesh.edges.push_back(
          {vertex(line[i].x, line[i].y), vertex(line[i + 1].x, line[i + 1].y), marker});
    return *this;
  }

  std::map<std::pair<double, double>, std::uint32_t> number{};
};

// The corners at the lower left and upper right have a triangle with two edges on land.
constexpr std::uint64_t kCorners = 2;

TEST(ModelRules, FindNothingInABlockButItsCorners) {
  // Circles of halves of a square share their centre.
  EXPECT_EQ(found(Squares().block(4, 4).mesh),
            (Totals{{"dead-corner", kCorners}, {"short-link", 16}}));
}

TEST(ModelRules, FindEdgesWithThreeTriangles) {
  Squares squares;
  squares.block(1, 1);
  squares.mesh.triangles.push_back(
      {squares.vertex(0, 0), squares.vertex(1, 0), squares.vertex(1, -1)});
  squares.mesh.triangles.push_back(
      {squares.vertex(0, 0), squares.vertex(1, 0), squares.vertex(0, -1)});
  EXPECT_EQ(found(squares.mesh), (Totals{{"conformity", 1}}));
}

TEST(ModelRules, FindIdleAndPinchedVerticesAndParts) {
  Squares squares;
  squares.block(3, 3).block(2, 2, 3, 3);
  squares.mesh.vertices.push_back({9, 9});
  const ModelReport report = judge_for_models({.mesh = squares.mesh});
  EXPECT_EQ(report.total(ModelRule::kIdleVertex), 1u);
  EXPECT_EQ(report.total(ModelRule::kPinchedVertex), 1u);
  EXPECT_EQ(report.total(ModelRule::kOnePart), 1u);
  EXPECT_EQ(report.parts, 2u);
  for (const ModelFinding& finding : report.findings) {
    if (finding.rule == ModelRule::kPinchedVertex) EXPECT_EQ(finding.at, (Vec2{3, 3}));
    if (finding.rule == ModelRule::kOnePart) EXPECT_EQ(finding.measure, 8);
  }
}

TEST(ModelRules, FindOpenBoundariesThatAreRings) {
  Squares squares;
  squares.block(4, 4).mark({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {4, 1}, {4, 2}}, 1);
  EXPECT_EQ(found(squares.mesh, {1}).count("open-ring"), 0u);
  squares.mark({{4, 2}, {4, 3}, {4, 4}, {3, 4}, {2, 4}, {1, 4}, {0, 4}}, 1);
  squares.mark({{0, 4}, {0, 3}, {0, 2}, {0, 1}, {0, 0}}, 1);
  EXPECT_EQ(found(squares.mesh, {1}).at("open-ring"), 1u);
  EXPECT_EQ(found(squares.mesh, {2}).count("open-ring"), 0u);
}

TEST(ModelRules, FindOpenBoundariesOfOneEdge) {
  Squares squares;
  squares.block(4, 4).mark({{1, 0}, {2, 0}}, 1).mark({{1, 4}, {2, 4}, {3, 4}}, 2);
  EXPECT_EQ(found(squares.mesh, {1, 2}).at("short-open"), 1u);
  EXPECT_EQ(found(squares.mesh, {2}).count("short-open"), 0u);
}

TEST(ModelRules, FindOpenBoundariesOnIslands) {
  Squares squares;
  for (int j = 0; j < 5; ++j)
    for (int i = 0; i < 5; ++i)
      if (i != 2 || j != 2) squares.add(i, j);
  squares.mark({{2, 2}, {3, 2}, {3, 3}}, 1).mark({{0, 0}, {1, 0}, {2, 0}}, 2);
  EXPECT_EQ(found(squares.mesh, {1}).at("open-island"), 1u);
  EXPECT_EQ(found(squares.mesh, {2}).count("open-island"), 0u);
}

TEST(ModelRules, FindVerticesOfManyTriangles) {
  const auto fan = [](std::uint32_t triangles) {
    Mesh mesh;
    mesh.vertices.push_back({0, 0});
    for (std::uint32_t i = 0; i < triangles; ++i) {
      const double angle = 2 * std::acos(-1.0) * i / triangles;
      mesh.vertices.push_back({std::cos(angle), std::sin(angle)});
      mesh.triangles.push_back({0, i + 1, (i + 1) % triangles + 1});
    }
    return mesh;
  };
  EXPECT_EQ(found(fan(8)).count("valence"), 0u);
  const Mesh mesh = fan(9);
  const ModelReport report = judge_for_models({.mesh = mesh});
  EXPECT_EQ(report.total(ModelRule::kValence), 1u);
  EXPECT_EQ(report.max_valence, 9u);
}

// Two blocks, and a channel of three squares between: three diagonals and four walls cross it.
TEST(ModelRules, FindChannelsOneTriangleWide) {
  Squares squares;
  squares.block(3, 3).block(3, 1, 3, 1).block(3, 3, 6, 0);
  EXPECT_EQ(found(squares.mesh).at("channel"), 7u);
}

TEST(ModelRules, CountNoEdgeAcrossACornerAsAChannel) {
  EXPECT_EQ(found(Squares().block(3, 1).mesh).at("channel"), 3u);  // of two walls, three diagonals
}

TEST(ModelRules, CountNoCornerWhoseEdgeIsOpen) {
  Squares squares;
  squares.block(4, 4).mark({{0, 0}, {1, 0}, {2, 0}}, 1);
  EXPECT_EQ(found(squares.mesh, {1}).at("dead-corner"), kCorners - 1);
}

// Two triangles at the edge from (-1, 0) to (1, 0).
Mesh kite(Vec2 upper, Vec2 lower) {
  Mesh mesh;
  mesh.vertices = {{-1, 0}, {1, 0}, upper, lower};
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
  return mesh;
}
double cosine(const Mesh& mesh) {
  return judge_for_models({.mesh = mesh}).max_cosine;
}

TEST(ModelRules, MeasureLinksBetweenCentersOfCells) {
  EXPECT_NEAR(cosine(kite({0.2, 2}, {-0.4, -2})), 0, 1e-12);  // on the edge's bisector
  EXPECT_NEAR(cosine(kite({0, 0.5}, {0, -2})), 0, 1e-12);     // that of the upper cell on the edge
  // The upper cell's is on the side from (-1, 0) to (3, 0.3), the lower one's at (0, -0.75).
  const Mesh mesh = kite({3, 0.3}, {0, -2});
  const ModelReport report = judge_for_models({.mesh = mesh});
  EXPECT_NEAR(report.max_cosine, 0.74, 0.01);
  EXPECT_EQ(report.total(ModelRule::kOrthogonality), 1u);
}

TEST(ModelRules, FindShortLinks) {
  EXPECT_EQ(found(kite({0, 1}, {0, -1})).at("short-link"), 1u);  // both centres are on the edge
  EXPECT_EQ(found(kite({0, 1.3}, {0, -1.3})).count("short-link"), 0u);
}

TEST(ModelRules, GiveTheTimeStepOfTheShortestEdgeByDepth) {
  Squares squares;
  squares.block(2, 1);
  std::vector<double> depths(squares.mesh.vertices.size(), -1);
  EXPECT_FALSE(judge_for_models({.mesh = squares.mesh, .depths = depths}).time_step);
  depths[squares.vertex(2, 0)] = 9.81;
  const ModelReport report = judge_for_models({.mesh = squares.mesh, .depths = depths});
  ASSERT_TRUE(report.time_step);
  EXPECT_NEAR(report.time_step->seconds, 1 / 9.81, 1e-12);
  EXPECT_EQ(report.time_step->length, 1);
  EXPECT_EQ(report.shortest_edge, 1);
}

TEST(ModelRules, MeasureDegreesInMetres) {
  Squares squares;
  squares.block(1, 1, 0, 60);
  const ModelReport report = judge_for_models({.mesh = squares.mesh, .lonlat = true});
  EXPECT_NEAR(*report.shortest_edge, 111195.08 * std::cos(61 * std::acos(-1.0) / 180), 1);
}

TEST(ModelRules, AreFaultsOfSomeModels) {
  EXPECT_EQ(grade(Model::kAdcirc, ModelRule::kPinchedVertex), Grade::kFault);
  EXPECT_EQ(grade(Model::kDelft3d, ModelRule::kPinchedVertex), Grade::kNone);
  EXPECT_EQ(grade(Model::kDelft3d, ModelRule::kOrthogonality), Grade::kFault);
  EXPECT_EQ(grade(Model::kTelemac, ModelRule::kDeadCorner), Grade::kAdvice);
}

}  // namespace
}  // namespace weft::check

// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/validate.h"

#include <gtest/gtest.h>

#include <limits>

#include "engine/domain/domain.h"
#include "tests/engine/domain/shapes.h"

namespace weft {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void expect_error(const Pslg& pslg, ErrorCode code, const std::string& field,
                  const std::string& message) {
  const ExecutionContext context;
  const Result<Domain> domain = triangulate(pslg, context);
  ASSERT_FALSE(domain);
  EXPECT_EQ(domain.error().code, code);
  EXPECT_EQ(domain.error().field, field);
  EXPECT_EQ(domain.error().message, message);
}

TEST(Validate, NamesTheCoordinateThatIsNotANumber) {
  Pslg pslg = square();
  pslg.points[2].y = kNan;
  expect_error(pslg, ErrorCode::kBadCoordinate, "domain.points[2].y",
               "the y coordinate is nan; coordinates must be finite");
}

TEST(Validate, NamesTheCoordinateThatIsInfinite) {
  Pslg pslg = square();
  pslg.points[3].x = -kInfinity;
  expect_error(pslg, ErrorCode::kBadCoordinate, "domain.points[3].x",
               "the x coordinate is -inf; coordinates must be finite");
}

TEST(Validate, RefusesMagnitudesWhoseProductsOverflow) {
  Pslg pslg = square();
  pslg.points[1].x = 2e50;
  expect_error(
      pslg, ErrorCode::kBadCoordinate, "domain.points[1].x",
      "the x coordinate is 2.0000000000000002e+50; magnitudes must be 0 or from 1e-100 to 1e50");
}

TEST(Validate, RefusesMagnitudesWhoseProductsUnderflow) {
  Pslg pslg = square();
  pslg.points[1].y = -1e-101;
  expect_error(
      pslg, ErrorCode::kBadCoordinate, "domain.points[1].y",
      "the y coordinate is -1.0000000000000001e-101; magnitudes must be 0 or from 1e-100 to 1e50");
}

TEST(Validate, TakesTheLimitsThemselves) {
  const ExecutionContext context;
  EXPECT_TRUE(triangulate(square(1e50), context));
  EXPECT_TRUE(triangulate(square(1e-100), context));
}

TEST(Validate, NamesTheHoleWithABadCoordinate) {
  Pslg pslg = square();
  pslg.holes = {{0.5, 0.5}, {kNan, 0}};
  expect_error(pslg, ErrorCode::kBadCoordinate, "domain.holes[1].x",
               "the x coordinate is nan; coordinates must be finite");
}

TEST(Validate, NamesTheRegionWithABadCoordinate) {
  Pslg pslg = square();
  pslg.regions = {{.at = {0.5, kInfinity}, .id = 1, .max_area = {}}};
  expect_error(pslg, ErrorCode::kBadCoordinate, "domain.regions[0].y",
               "the y coordinate is inf; coordinates must be finite");
}

TEST(Validate, RefusesAMaximumAreaThatIsNotPositive) {
  Pslg pslg = square();
  pslg.regions = {{.at = {0.5, 0.5}, .id = 1, .max_area = 1},
                  {.at = {0.5, 0.5}, .id = 1, .max_area = 0}};
  expect_error(pslg, ErrorCode::kBadOption, "domain.regions[1].max_area",
               "the maximum area is 0; it must be finite and above 0");
}

TEST(Validate, RefusesAMaximumAreaThatIsNotFinite) {
  Pslg pslg = square();
  pslg.regions = {{.at = {0.5, 0.5}, .id = 1, .max_area = kInfinity}};
  expect_error(pslg, ErrorCode::kBadOption, "domain.regions[0].max_area",
               "the maximum area is inf; it must be finite and above 0");
}

TEST(Validate, NamesTheArcThatIsNone) {
  const auto expect = [](std::vector<Arc> arcs, ErrorCode code, const std::string& field,
                         const std::string& message) {
    Pslg pslg = square();
    pslg.segments.push_back({0, 0});
    pslg.arcs = std::move(arcs);
    expect_error(pslg, code, field, message);
  };
  expect({{0, 0.5}, {9, 1}}, ErrorCode::kIndexOutOfRange, "domain.arcs[1].segment",
         "arc 1 is segment 9, but there are 5 segments");
  expect({{1, 0.5}, {1, 0.5}}, ErrorCode::kBadOption, "domain.arcs[1]", "segment 1 has two arcs");
  expect({{1, kNan}}, ErrorCode::kBadOption, "domain.arcs[0]",
         "the bulge is nan; its magnitude must be at most 1000000");
  expect({{1, -2e6}}, ErrorCode::kBadOption, "domain.arcs[0]",
         "the bulge is -2000000; its magnitude must be at most 1000000");
  expect({{4, 1}}, ErrorCode::kBadOption, "domain.arcs[0]",
         "the arc of segment 4 ends where it begins, at (0, 0); a circle is two arcs or more");
}

TEST(Validate, RefusesASnapDistanceThatIsNoDistance) {
  Pslg pslg = square();
  for (const auto& [snap, text] :
       {std::pair{-1.0, "-1"}, std::pair{kNan, "nan"}, std::pair{kInfinity, "inf"}}) {
    pslg.snap = snap;
    expect_error(pslg, ErrorCode::kBadOption, "domain.snap",
                 "the snap distance is " + std::string(text) + "; it must be finite and 0 or more");
  }
}

TEST(Validate, TakesTheLargestSnapDistance) {
  Pslg pslg = square();
  pslg.snap = std::numeric_limits<double>::max();
  const ExecutionContext context;
  const Result<Domain> domain = triangulate(pslg, context);
  ASSERT_FALSE(domain);
  EXPECT_EQ(domain.error().code, ErrorCode::kEmptyDomain);
}

TEST(Validate, NamesTheSegmentEndThatIsOutOfRange) {
  Pslg pslg = square();
  pslg.segments[1].a = 4;
  expect_error(pslg, ErrorCode::kIndexOutOfRange, "domain.segments[1].a",
               "segment 1 ends at point 4, but there are 4 points");
  pslg = square();
  pslg.segments[3].b = kNone;
  expect_error(pslg, ErrorCode::kIndexOutOfRange, "domain.segments[3].b",
               "segment 3 ends at point 4294967295, but there are 4 points");
}

TEST(Validate, TakesSegmentsWhoseEndsAreTheSamePoint) {
  Pslg pslg = square();
  pslg.points.push_back({1, -0.0});
  pslg.segments.push_back({2, 2});
  pslg.segments.push_back({1, 4});
  const Result<Domain> domain = triangulate(pslg, ExecutionContext());
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->triangles.size(), 2u);
  EXPECT_EQ(domain->subsegments.size(), 4u);
  EXPECT_EQ(domain->merging.vanished_faces, 0u);
}

TEST(Validate, RefusesAnEmptyPslg) {
  expect_error({}, ErrorCode::kTooFewPoints, "domain.points",
               "there are 0 points, 0 of them distinct; a domain needs at least 3");
}

TEST(Validate, CountsCoincidentPointsOnce) {
  Pslg pslg;
  pslg.points = {{0, 0}, {1, 1}, {0, 0}, {1, 1}, {1, 1}};
  pslg.segments = {{0, 1}};
  expect_error(pslg, ErrorCode::kTooFewPoints, "domain.points",
               "there are 5 points, 2 of them distinct; a domain needs at least 3");
  pslg.points = {{7, 7}, {7, 7}, {7, 7}};
  pslg.segments.clear();
  expect_error(pslg, ErrorCode::kTooFewPoints, "domain.points",
               "there are 3 points, 1 of them distinct; a domain needs at least 3");
}

TEST(Validate, RefusesPointsThatAllLieOnOneLine) {
  Pslg pslg;
  pslg.points = {{0, 0}, {0, 0}, {3, 1}, {6, 2}, {-3, -1}};
  pslg.segments = {{0, 2}};
  expect_error(pslg, ErrorCode::kCollinearPoints, "domain.points",
               "all 5 points lie on the line through (0, 0) and (3, 1)");
}

TEST(Validate, NamesTheFirstOffender) {
  Pslg pslg = square();
  pslg.segments[0].a = 9;
  pslg.segments[1].b = 9;
  pslg.points[3].y = kNan;
  pslg.points[2].x = kNan;
  expect_error(pslg, ErrorCode::kBadCoordinate, "domain.points[2].x",
               "the x coordinate is nan; coordinates must be finite");
}

}  // namespace
}  // namespace weft

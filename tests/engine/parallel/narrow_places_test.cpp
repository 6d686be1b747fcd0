// SPDX-License-Identifier: Apache-2.0
#include "engine/parallel/narrow_places.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "engine/engine.h"
#include "tests/engine/domain/shapes.h"
#include "tests/support/poly.h"

namespace weft {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Forgetful : ChunkSink {
  bool accept(Chunk&&) override { return true; }
};

NarrowPlaces places_of(const Pslg& pslg, double min_angle_deg, double size = kInfinity) {
  const ExecutionContext context;
  const auto domain = triangulate(pslg, context);
  EXPECT_TRUE(domain);
  auto places = NarrowPlaces::find(
      *domain, {}, QualityBounds::from(min_angle_deg, 0, 1e-12), [&](Point) { return size; },
      context);
  EXPECT_TRUE(places);
  return places ? *places : NarrowPlaces();
}

double triangles_of(const Pslg& pslg, double min_angle_deg) {
  ExecutionContext context;
  Forgetful sink;
  const auto summary = generate_mesh({.pslg = pslg, .min_angle_deg = min_angle_deg}, sink, context);
  EXPECT_TRUE(summary);
  return summary ? static_cast<double>(summary->triangles) : 0;
}

// Two segments of length 8 in a square of side 10.
Pslg side_by_side(double gap, double shift) {
  Pslg pslg = square(10);
  add_segment(pslg, {1, 5}, {9, 5});
  add_segment(pslg, {1 + shift, 5 + gap}, {9 + shift, 5 + gap});
  return pslg;
}

Pslg strip(double width) {
  Pslg pslg;
  add_box(pslg, {0, 0}, {10, width});
  return pslg;
}

// A comb: so many walls of a thickness, which do not touch.
Pslg walls(int count, double thickness) {
  Pslg pslg = square(10);
  for (int i = 0; i < count; ++i) {
    const double x = 1 + 8.0 * i / count;
    add_box(pslg, {x, 1 + 0.01 * i}, {x + thickness, 9});
  }
  return pslg;
}

struct Case {
  std::string name;
  Pslg pslg;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const double gap : {0.0023, 0.0031, 0.0042, 0.02}) {
    const std::string text = std::to_string(gap);
    all.push_back({"segments " + text, side_by_side(gap, 0)});
    all.push_back({"segments, shifted, " + text, side_by_side(gap, 0.6 * gap)});
    all.push_back({"strip " + text, strip(gap)});
  }
  all.push_back({"walls", walls(12, 0.01)});
  return all;
}

TEST(NarrowPlaces, AreEstimatedWithinAFactorOfTwo) {
  for (const Case& c : cases()) {
    for (const double angle : {20, 25, 30}) {
      const double triangles = triangles_of(c.pslg, angle);
      const double expected = places_of(c.pslg, angle).expected();
      EXPECT_LT(expected, 2 * triangles) << c.name << ", " << angle;
      EXPECT_GT(expected, 0.5 * triangles) << c.name << ", " << angle;
    }
  }
}

TEST(NarrowPlaces, HaveTheirLowerBoundInEveryMesh) {
  for (const Case& c : cases()) {
    for (const double angle : {5, 10, 15, 20, 25, 30, 33, 36}) {
      const double lower_bound = places_of(c.pslg, angle).lower_bound();
      EXPECT_GT(lower_bound, 0) << c.name << ", " << angle;
      EXPECT_LT(1.3 * lower_bound, triangles_of(c.pslg, angle)) << c.name << ", " << angle;
    }
  }
}

TEST(NarrowPlaces, AreNoneWithoutABoundOnAngles) {
  const NarrowPlaces places = places_of(side_by_side(0.001, 0), 0);
  EXPECT_EQ(places.expected(), 0);
  EXPECT_EQ(places.lower_bound(), 0);
}

TEST(NarrowPlaces, CostNothingWhereTheSizeIsFiner) {
  EXPECT_EQ(places_of(side_by_side(0.01, 0), 20, 1e-5).expected(), 0);
  EXPECT_GT(places_of(side_by_side(0.01, 0), 20, 1e-2).expected(), 1000);
}

TEST(NarrowPlaces, OfAVertexNearASegmentCostALogarithm) {
  Pslg pslg = square(10);
  pslg.points.push_back({3.7, 1e-6});
  const NarrowPlaces places = places_of(pslg, 20);
  EXPECT_LT(places.expected(), 1000);
  EXPECT_EQ(places.lower_bound(), 0);
}

TEST(NarrowPlaces, AreFewAlongACoast) {
  const NarrowPlaces places = places_of(read_poly(model("us-east-coast.poly")), 20);
  EXPECT_LT(places.expected(), 1000);
  EXPECT_LT(places.lower_bound(), 100);
}

TEST(NarrowPlaces, KnowWhatIsCostliest) {
  const NarrowPlaces places = places_of(side_by_side(0.003, 0), 20);
  ASSERT_TRUE(places.costliest());
  const auto& c = *places.costliest();
  EXPECT_EQ(std::min(c.segment, c.other), 4u);
  EXPECT_EQ(std::max(c.segment, c.other), 5u);
  EXPECT_NEAR(c.width, 0.003, 1e-9);
  EXPECT_NEAR(c.at.y, 5, 0.01);
  EXPECT_GT(c.at.x, 1);
  EXPECT_LT(c.at.x, 9);
}

TEST(NarrowPlaces, AreToldOfAMeshIfOneMakesAFifthOfIt) {
  ExecutionContext context;
  Forgetful sink;
  const auto narrow = generate_mesh({.pslg = side_by_side(0.003, 0)}, sink, context);
  ASSERT_TRUE(narrow);
  ASSERT_TRUE(narrow->narrow);
  EXPECT_EQ(std::min(narrow->narrow->segment, narrow->narrow->other), 4u);
  EXPECT_EQ(std::max(narrow->narrow->segment, narrow->narrow->other), 5u);
  EXPECT_NEAR(narrow->narrow->width, 0.003, 1e-9);
  EXPECT_NEAR(narrow->narrow->at.y, 5, 0.01);
  const auto triangles = static_cast<double>(narrow->triangles);
  EXPECT_GE(narrow->narrow->triangles, 0.2 * triangles);
  EXPECT_LE(narrow->narrow->triangles, triangles);
  EXPECT_NEAR(narrow->narrow->in_all, narrow->narrow->triangles, 1e-6 * triangles);
  EXPECT_NEAR(narrow->narrow->widest, 0.003, 1e-6);

  const auto wide = generate_mesh({.pslg = side_by_side(0.5, 0), .size = 1e-3}, sink, context);
  ASSERT_TRUE(wide);
  EXPECT_FALSE(wide->narrow);
}

TEST(NarrowPlaces, AreToldOfAMeshIfAllTogetherMakeAFifthOfIt) {
  Pslg pslg = square(100);
  constexpr int kPlaces = 12;
  for (int i = 0; i < kPlaces; ++i) {
    const double y = 8 + 7.5 * i;
    const double gap = i == 7 ? 0.08 : 0.09;
    add_segment(pslg, {10, y}, {90, y});
    add_segment(pslg, {10, y + gap}, {90, y + gap});
  }
  ExecutionContext context;
  Forgetful sink;
  const auto made = generate_mesh({.pslg = pslg}, sink, context);
  ASSERT_TRUE(made);
  ASSERT_TRUE(made->narrow);
  const NarrowPlace& narrow = *made->narrow;
  EXPECT_NEAR(narrow.width, 0.08, 1e-9);
  EXPECT_NEAR(narrow.at.y, 8 + 7.5 * 7, 0.081);
  EXPECT_NEAR(narrow.widest, 0.09, 1e-6);
  const auto triangles = static_cast<double>(made->triangles);
  EXPECT_LT(narrow.triangles, 0.2 * triangles);
  EXPECT_GT(narrow.in_all, 0.2 * triangles);
  EXPECT_LT(narrow.in_all, triangles);
  EXPECT_NEAR(narrow.in_all, kPlaces * narrow.triangles, 0.2 * narrow.in_all);
}

TEST(NarrowPlaces, AreSampledWhereTheyAre) {
  const NarrowPlaces places = places_of(side_by_side(0.003, 0), 20);
  std::vector<Quadtree::Sample> samples;
  places.add_samples(100, samples);
  double sum = 0;
  for (const Quadtree::Sample& s : samples) {
    EXPECT_LE(s.weight, 100 * (1 + 1e-9));
    EXPECT_NEAR(s.at.y, 5, 0.01);
    sum += s.weight;
  }
  EXPECT_NEAR(sum, places.expected(), 1e-6 * places.expected());
}

TEST(NarrowPlaces, ThatCostTooMuchAreRefusedAtOnceAndNamed) {
  ExecutionContext context({.triangle_limit = 1'000'000});
  Forgetful sink;
  const auto result = generate_mesh({.pslg = side_by_side(2e-6, 0)}, sink, context);
  ASSERT_FALSE(result);
  EXPECT_LT(context.progress().stage, Stage::kRefine);
  EXPECT_LT(context.pulse(), 1000u);
  EXPECT_EQ(result.error().code, ErrorCode::kLimitExceeded);
  EXPECT_EQ(result.error().field, "quality.min_angle_deg");
  const std::string& message = result.error().message;
  EXPECT_NE(message.find("1000000"), std::string::npos) << message;
  EXPECT_NE(message.find("between segments 4 and 5"), std::string::npos) << message;
}

TEST(NarrowPlaces, ThatFitAreNotRefused) {
  const Pslg pslg = side_by_side(0.003, 0);
  ExecutionContext context({.triangle_limit = static_cast<std::uint64_t>(triangles_of(pslg, 20))});
  Forgetful sink;
  EXPECT_TRUE(generate_mesh({.pslg = pslg}, sink, context));
}

TEST(NarrowPlaces, AreExpectedAndShown) {
  ExecutionContext context;
  Forgetful sink;
  const auto summary = generate_mesh({.pslg = side_by_side(0.003, 0)}, sink, context);
  ASSERT_TRUE(summary);
  const auto expected = static_cast<double>(context.progress().expected_triangles);
  EXPECT_GT(expected, 0.5 * static_cast<double>(summary->triangles));
  EXPECT_LT(expected, 2.0 * static_cast<double>(summary->triangles));
}

}  // namespace
}  // namespace weft

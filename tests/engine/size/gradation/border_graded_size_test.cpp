// SPDX-License-Identifier: Apache-2.0
#include "engine/size/gradation/border_graded_size.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "engine/size/edge_size.h"
#include "engine/size/expression/expression.h"
#include "engine/size/fields/distance_field.h"
#include "engine/size/gradation/graded_size.h"
#include "engine/size/size_spec.h"
#include "tests/engine/domain/shapes.h"
#include "tests/engine/size/fields/field_laws.h"

namespace weft {
namespace {

// A square with a square hole, a slanted one and a line inside: the largest distance is about 2.
Pslg room() {
  Pslg pslg = square(8);
  add_box(pslg, {3, 3}, {5, 5});
  add_ring(pslg, {{1, 6}, {2, 5.5}, {2.5, 6.5}, {1.5, 7}});
  add_segment(pslg, {6, 1}, {7, 2});
  pslg.holes = {{4, 4}, {1.7, 6.3}};
  return pslg;
}

// A length of edges that may name the distance d to the segments of `room`.
struct Limited {
  Limited(const std::string& text, double gradation)
      : pslg(room()),
        domain(*triangulate(pslg, context)),
        distance(*DistanceField::make(lines(), kBox, context)),
        expression(*Expression::parse(text, std::vector<NamedField>{{"d", &distance}})),
        edge(expression),
        size(*BorderGradedSize::make(edge, distance, kAll, gradation, kBox, context)) {}

  std::vector<Line> lines() const {
    std::vector<Line> lines;
    for (const Segment& s : pslg.segments) lines.push_back({pslg.points[s.a], pslg.points[s.b]});
    return lines;
  }
  double operator()(Point p) const { return SizeFunction::edge_of_area((*size)(p)); }

  static constexpr Box kBox{0, 0, 8, 8};
  static constexpr auto kAll = BorderGradedSize::Lines::kWholeBorder;
  ExecutionContext context;
  Pslg pslg;
  Domain domain;
  DistanceField distance;
  Expression expression;
  EdgeSize edge;
  std::unique_ptr<const BorderGradedSize> size;
};

bool inside(const Domain& domain, Point p) {
  for (const auto& t : domain.triangles) {
    bool all = true;
    for (unsigned k = 0; k < 3; ++k) {
      const Point a = domain.vertices[t.vertex[k]];
      const Point b = domain.vertices[t.vertex[(k + 1) % 3]];
      all = all && (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) >= 0;
    }
    if (all) return true;
  }
  return false;
}

std::vector<Point> points_in(const Domain& domain, int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Point> points;
  while (points.size() < static_cast<std::size_t>(count)) {
    const Point p = random_point(Limited::kBox, random);
    if (inside(domain, p)) points.push_back(p);
  }
  return points;
}

void expect_limit(const std::string& text, double gradation,
                  const std::function<double(double)>& exact) {
  SCOPED_TRACE(text);
  const Limited limited(text, gradation);
  ASSERT_NE(limited.size, nullptr);
  for (const Point p : points_in(limited.domain, 2000, 3)) {
    const double limit = exact(limited.distance(p));
    ASSERT_LE(limited(p), limit * (1 + 1e-9)) << p.x << " " << p.y;
    ASSERT_GE(limited(p), limit * (1 - BorderGradedSize::kTolerance)) << p.x << " " << p.y;
  }
}

TEST(BorderGradedSize, GrowsFromTheBorderIfTheSizeIsTooSteep) {
  expect_limit("0.1 + 0.6*d", 0.15, [](double d) { return 0.1 + 0.15 * d; });
  expect_limit("0.01 + 3*d", 2, [](double d) { return 0.01 + 2 * d; });
  expect_limit("clamp(0.05 + 0.3*d, 0.1, 0.3)", 0.15,
               [](double d) { return std::min(0.3, 0.1 + 0.15 * std::max(0.0, d - 0.05 / 0.3)); });
  expect_limit("min(0.02 + d^2, 0.3)", 0.5, [](double d) {
    // Its slope is G at the distance G/2.
    return std::min(0.3, d < 0.25 ? 0.02 + d * d : 0.02 + 0.0625 + 0.5 * (d - 0.25));
  });
}

TEST(BorderGradedSize, GrowsFromEachStep) {
  const auto limit = [](double d) { return std::min(0.1 + 0.2 * std::max(0.0, d - 0.3), 2.0); };
  expect_limit("d < 0.3 ? 0.1 : 2", 0.2, limit);
  expect_limit("0.1 + 0.1*floor(4*d)", 0.1, [](double d) {
    double least = 0.1 + 0.1 * std::floor(4 * d);
    for (int k = 1; k < 12; ++k)
      if (0.25 * k <= d) least = std::min(least, 0.1 * k + 0.1 * (d - 0.25 * k));
    return least;
  });
}

// Of random sizes that grow: by the distance itself, the steps of both, and the sources over the
// plane.
TEST(BorderGradedSize, AgreesWithTheLimitBySources) {
  std::mt19937_64 random(11);
  const auto number = [&](double lo, double hi) {
    return std::to_string(lo + (hi - lo) * uniform(random));
  };
  int made = 0;
  for (int round = 0; round < 12; ++round) {
    const double gradation = 0.1 + 0.4 * uniform(random);
    const std::string knee = number(0.05, 0.4);
    const std::vector<std::string> sizes{
        "min(" + number(0.4, 0.6) + " + " + number(0.5, 2) + "*d, " + number(0.8, 1) + ")",
        "max(0.4, " + number(0.6, 2) + "*(d + " + knee + "))",
        number(0.4, 0.6) + " + (d < " + knee + " ? 0 : " + number(0.1, 1) + ") + 0.05*d",
        number(0.4, 0.6) + " + " + number(1, 3) + "*d^2/(1 + d)"};
    const std::string& text = sizes[static_cast<std::size_t>(round) % sizes.size()];
    SCOPED_TRACE(text + " at " + std::to_string(gradation));
    const Limited limited(text, gradation);
    if (!limited.size) continue;
    ++made;
    const GradedSize by_sources =
        *GradedSize::make(limited.edge, gradation, limited.domain, limited.context);
    for (const Point p : points_in(limited.domain, 500, 7)) {
      const double other = SizeFunction::edge_of_area(by_sources(p));
      ASSERT_GE(limited(p), other * (1 - BorderGradedSize::kTolerance)) << p.x << " " << p.y;
      ASSERT_LE(limited(p), other / 0.95) << p.x << " " << p.y;
    }
  }
  EXPECT_GE(made, 9);
}

TEST(BorderGradedSize, BoundsHoldOverRandomBoxes) {
  for (const char* text : {"0.1 + 0.6*d", "d < 0.3 ? 0.1 : 2", "0.1 + 0.1*floor(4*d)",
                           "clamp(0.05 + 0.3*d, 0.1, 0.3)"}) {
    SCOPED_TRACE(text);
    const Limited limited(text, 0.15);
    ASSERT_NE(limited.size, nullptr);
    expect_bounds_to_hold(*limited.size, Limited::kBox, 0.5, 3000, true, 7);
    expect_same_bits_in_batches(*limited.size, Limited::kBox, 8);
  }
}

TEST(BorderGradedSize, BoundsAreTightInASmallBox) {
  const Limited limited("0.1 + 0.6*d", 0.15);
  const Interval bounds = limited.size->bounds({1, 3, 1.05, 3.05});
  EXPECT_LT(bounds.hi / bounds.lo, 1.1);
}

TEST(BorderGradedSize, IsLeftToTheSourcesIfTheSizeDependsOnMore) {
  EXPECT_EQ(Limited("0.1 + 0.6*d + 0*x", 0.15).size, nullptr);
  EXPECT_EQ(Limited("y < 1 ? 0.1 : 0.1 + 0.6*d", 0.15).size, nullptr);
  EXPECT_EQ(Limited("hypot(x, y) < 1 ? 0.1 : 3", 0.15).size, nullptr);
  EXPECT_EQ(Limited("0.1 + slope(d)*d", 0.15).size, nullptr);
}

TEST(BorderGradedSize, IsLeftToTheSourcesIfTheSizeNamesAnotherField) {
  const Limited limited("0.1 + 0.6*d", 0.15);
  const DistanceField other = *DistanceField::make(limited.lines(), Limited::kBox, limited.context);
  const auto made = BorderGradedSize::make(limited.edge, other, Limited::kAll, 0.15, Limited::kBox,
                                           limited.context);
  EXPECT_EQ(*made, nullptr);
}

TEST(BorderGradedSize, IsLeftToTheSourcesIfTheSizeFallsAwayFromTheBorder) {
  EXPECT_EQ(Limited("max(0.1, 2 - d)", 0.15).size, nullptr);
  EXPECT_EQ(Limited("d < 0.5 ? 1 : 0.1", 0.15).size, nullptr);
  EXPECT_EQ(Limited("0.2 + 0.1*sin(20*d)", 0.15).size, nullptr);
}

TEST(BorderGradedSize, IsLeftToTheSourcesWithoutASizeSomewhere) {
  EXPECT_EQ(Limited("sqrt(d - 0.5)", 0.15).size, nullptr);
  EXPECT_EQ(Limited("0.6*d", 0.15).size, nullptr);
  EXPECT_EQ(Limited("d - 0.5", 0.15).size, nullptr);
  EXPECT_EQ(Limited("1/d", 0.15).size, nullptr);
}

TEST(BorderGradedSize, IsNotNeededIfTheSizeKeepsToTheGradation) {
  EXPECT_EQ(Limited("0.1 + 0.15*d", 0.15).size, nullptr);
  EXPECT_EQ(Limited("2", 0.15).size, nullptr);
}

// A size that names the distance d to the segments of a room, or to those with the marker 5.
Size size_of(const std::string& text, const Pslg& pslg, std::vector<std::int32_t> markers) {
  SizeSpec spec(text);
  spec.measure = Measure::kEdge;
  spec.gradation = 0.15;
  spec.fields.push_back({"d", DistanceSpec{.markers = std::move(markers)}});
  const ExecutionContext context;
  return *make_size(spec, pslg, *triangulate(pslg, context), context);
}

bool is_by_border(const Size& size) {
  return dynamic_cast<const BorderGradedSize*>(&size.function()) != nullptr;
}

TEST(BorderGradedSize, LimitsTheDistanceToAllSegmentsOfARequest) {
  const Size size = size_of("0.1 + 0.6*d", room(), {});
  EXPECT_TRUE(is_by_border(size));
  EXPECT_NEAR(SizeFunction::edge_of_area(size.function()({4, 1})), 0.1 + 0.15, 3e-4);
}

// Walks to the hole's left side and to the line inside lead across other holes.
TEST(BorderGradedSize, LimitsTheDistanceToSegmentsWithAMarkerIfItGrowsFromThemAlone) {
  Pslg pslg = room();
  pslg.segments.back().marker = 5;
  pslg.segments[7].marker = 5;
  const ExecutionContext context;
  const Domain domain = *triangulate(pslg, context);
  std::vector<Line> lines;
  for (const std::size_t s : {std::size_t{7}, pslg.segments.size() - 1})
    lines.push_back({pslg.points[pslg.segments[s].a], pslg.points[pslg.segments[s].b]});
  const DistanceField distance = *DistanceField::make(lines, Limited::kBox, context);
  for (const char* text : {"0.1 + 0.6*d", "clamp(0.1 + 0.6*d, 0.2, 0.5)", "d < 0.01 ? 0.1 : 3"}) {
    SCOPED_TRACE(text);
    const Size size = size_of(text, pslg, {5});
    const Expression expression =
        *Expression::parse(text, std::vector<NamedField>{{"d", &distance}});
    const EdgeSize edge(expression);
    const GradedSize by_sources = *GradedSize::make(edge, 0.15, domain, context);
    for (const Point p : points_in(domain, 500, 7)) {
      const double got = SizeFunction::edge_of_area(size.function()(p));
      const double other = SizeFunction::edge_of_area(by_sources(p));
      ASSERT_GE(got, other * (1 - BorderGradedSize::kTolerance)) << p.x << " " << p.y;
      ASSERT_LE(got, other / 0.95) << p.x << " " << p.y;
    }
    EXPECT_EQ(is_by_border(size), std::string(text) == "0.1 + 0.6*d");
  }
  // Files have borders twice, as rings without a marker and as lines with one.
  Pslg twice = room();
  add_segment(twice, {0, 0}, {8, 0}, 5);
  add_segment(twice, {8, 0}, {0, 0}, 5);
  EXPECT_TRUE(is_by_border(size_of("0.1 + 0.6*d", twice, {5})));
  EXPECT_FALSE(is_by_border(size_of("d < 0.5 ? 0.1 : 2", pslg, {5})));
  EXPECT_FALSE(is_by_border(size_of("max(0.1, 0.2 - 300*d) + d", pslg, {5})));
}

TEST(BorderGradedSize, IsLeftToTheSourcesIfSegmentsWithTheMarkerLeaveTheDomain) {
  Pslg in_hole = room();
  add_segment(in_hole, {3.5, 3.5}, {4.5, 3.5}, 5);
  Pslg across = room();
  add_segment(across, {2, 3.5}, {6, 3.5}, 5);
  across.holes.push_back({4, 3.2});
  for (const Pslg& pslg : {in_hole, across})
    EXPECT_FALSE(is_by_border(size_of("0.1 + 0.6*d", pslg, {5})));
}

TEST(BorderGradedSize, CanBeCancelled) {
  Limited limited("0.1 + 0.6*d", 0.15);
  limited.context.cancel();
  const auto made = BorderGradedSize::make(limited.edge, limited.distance, Limited::kAll, 0.15,
                                           Limited::kBox, limited.context);
  ASSERT_FALSE(made.has_value());
  EXPECT_EQ(made.error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace weft

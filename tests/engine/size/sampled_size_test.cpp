// SPDX-License-Identifier: Apache-2.0
#include "engine/size/sampled_size.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/size/size_spec.h"
#include "tests/engine/domain/shapes.h"

namespace weft {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;
using testing::IsNan;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The square from 0 to 4, whose hole is from 1 to 2, and whose part above 3 has the bound 0.25.
Pslg holed() {
  Pslg pslg = square(4);
  add_box(pslg, {1, 1}, {2, 2});
  pslg.holes.push_back({1.5, 1.5});
  add_segment(pslg, {0, 3}, {4, 3});
  pslg.regions.push_back({.at = {1, 3.5}, .id = 7, .max_area = 0.25});
  return pslg;
}

Result<SampledSize> sampled_over(const Pslg& pslg, const SizeSpec& spec,
                                 const std::vector<Point>& points) {
  const ExecutionContext context;
  const Result<Domain> domain = triangulate(pslg, context);
  const Result<Size> size = make_size(spec, pslg, *domain, context);
  EXPECT_TRUE(size) << size.error().message;
  return sample_size(size->function(), *domain, points, context);
}

std::vector<double> sampled(const std::optional<std::string>& text,
                            const std::vector<Point>& points) {
  return sampled_over(holed(), text ? SizeSpec(*text) : SizeSpec(), points)->bounds;
}

TEST(SampledSize, IsTheLeastOfTheSizeAndTheRegionsBound) {
  EXPECT_THAT(sampled("0.1*x", {{1, 0.5}, {3, 2}, {1, 3.5}, {3.5, 3.5}}),
              ElementsAre(DoubleEq(0.1), DoubleEq(0.3), DoubleEq(0.1), DoubleEq(0.25)));
}

TEST(SampledSize, IsInfiniteWithoutABoundAndNoneOutsideOfTheDomain) {
  EXPECT_THAT(sampled({}, {{1, 0.5}, {1, 3.5}, {1.5, 1.5}, {-1, 0.5}, {1e50, -1e50}}),
              ElementsAre(kInfinity, 0.25, IsNan(), IsNan(), IsNan()));
}

TEST(SampledSize, IsThatOfTheDomainOnItsBorder) {
  EXPECT_THAT(sampled("0.5", {{0, 0}, {4, 2}, {1, 1}, {2, 1.5}}), ElementsAre(0.5, 0.5, 0.5, 0.5));
}

TEST(SampledSize, IsZeroWhereThereIsNone) {
  EXPECT_THAT(sampled("x - 2", {{1, 0.5}, {2, 0.5}, {3, 0.5}, {-5, 0}}),
              ElementsAre(0, 0, 1, IsNan()));
  EXPECT_THAT(sampled("1/(x-3)", {{3, 0.5}}), ElementsAre(0));
  EXPECT_THAT(sampled("log(x-3)", {{1, 0.5}}), ElementsAre(0));
}

TEST(SampledSize, OfManyPointsIsThatOfEach) {
  std::vector<Point> points;
  for (int i = 0; i < 1003; ++i) points.push_back({0.0039 * i, 0.5});
  const auto bounds = sampled("0.1 + x", points);
  ASSERT_EQ(bounds.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(bounds[i], 0.1 + points[i].x) << i;
}

TEST(SampledSize, TellsTheIntegralOverTheDomain) {
  // 16 less the hole's 1, and 4 of it bounded by the region.
  EXPECT_NEAR(sampled_over(holed(), SizeSpec(0.5), {})->per_bound, 11 / 0.5 + 4 / 0.25, 0.3);
  EXPECT_NEAR(sampled_over(square(4), SizeSpec("1 + x"), {})->per_bound, 4 * std::log(5), 1e-3);
  EXPECT_EQ(sampled_over(square(4), {}, {})->per_bound, 0);
}

TEST(SampledSize, IsBadInAPartOfTheDomainAlone) {
  const std::vector<Point> middle = {{2, 2}};
  const auto bad = [&](const char* text) { return sampled_over(square(4), text, middle)->bad; };
  EXPECT_EQ(bad("1"), std::nullopt);
  EXPECT_EQ(bad("hypot(x-2, y-2)"), std::nullopt);  // at a place
  EXPECT_EQ(bad("abs(x-y)"), std::nullopt);         // on a line, through cells
  EXPECT_EQ(bad("abs(x-2)"), std::nullopt);
  EXPECT_EQ(bad("max(hypot(x-2, y-2) - 1e-3, 0)"), (Point{2, 2}));  // in a small circle
  EXPECT_TRUE(bad("x - 1"));                                        // beside the middle
  EXPECT_EQ(bad("5 - x"), std::nullopt);                            // bad outside alone
  EXPECT_EQ(bad("sqrt(x - 2)"), (Point{2, 2}));
}

TEST(SampledSize, IsZeroOnASegmentFromWhichItGrows) {
  const auto on_border = sampled_over(square(4), "x", {{0, 0}, {0, 1}, {0, 4}, {1, 1}});
  EXPECT_EQ(on_border->bad, std::nullopt);
  EXPECT_THAT(on_border->bounds, ElementsAre(0, 0, 0, 1));
}

}  // namespace
}  // namespace weft

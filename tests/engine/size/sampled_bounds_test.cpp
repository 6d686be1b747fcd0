// SPDX-License-Identifier: Apache-2.0
#include "engine/size/sampled_bounds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

Result<std::vector<double>> sampled(const std::optional<std::string>& text,
                                    const std::vector<Point>& points) {
  const ExecutionContext context;
  const Pslg pslg = holed();
  const Result<Domain> domain = triangulate(pslg, context);
  const SizeSpec spec = text ? SizeSpec(*text) : SizeSpec();
  const Result<Size> size = make_size(spec, pslg, *domain, context);
  EXPECT_TRUE(size) << size.error().message;
  return sampled_bounds(size->function(), *domain, points, context);
}

TEST(SampledBounds, AreTheLeastOfTheSizeAndTheRegionsBound) {
  EXPECT_THAT(*sampled("0.1*x", {{1, 0.5}, {3, 2}, {1, 3.5}, {3.5, 3.5}}),
              ElementsAre(DoubleEq(0.1), DoubleEq(0.3), DoubleEq(0.1), DoubleEq(0.25)));
}

TEST(SampledBounds, AreInfiniteWithoutABoundAndNoneOutsideOfTheDomain) {
  EXPECT_THAT(*sampled({}, {{1, 0.5}, {1, 3.5}, {1.5, 1.5}, {-1, 0.5}, {1e50, -1e50}}),
              ElementsAre(kInfinity, 0.25, IsNan(), IsNan(), IsNan()));
}

TEST(SampledBounds, AreThoseOfTheDomainOnItsBorder) {
  EXPECT_THAT(*sampled("0.5", {{0, 0}, {4, 2}, {1, 1}, {2, 1.5}}), ElementsAre(0.5, 0.5, 0.5, 0.5));
}

TEST(SampledBounds, AreZeroWhereTheSizeIsNone) {
  EXPECT_THAT(*sampled("x - 2", {{1, 0.5}, {2, 0.5}, {3, 0.5}, {-5, 0}}),
              ElementsAre(0, 0, 1, IsNan()));
  EXPECT_THAT(*sampled("1/(x-3)", {{3, 0.5}}), ElementsAre(0));
  EXPECT_THAT(*sampled("log(x-3)", {{1, 0.5}}), ElementsAre(0));
}

TEST(SampledBounds, OfManyPointsAreThoseOfEach) {
  std::vector<Point> points;
  for (int i = 0; i < 1003; ++i) points.push_back({0.0039 * i, 0.5});
  const auto bounds = sampled("0.1 + x", points);
  ASSERT_EQ(bounds->size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ((*bounds)[i], 0.1 + points[i].x) << i;
}

}  // namespace
}  // namespace weft

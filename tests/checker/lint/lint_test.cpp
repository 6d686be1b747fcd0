// SPDX-License-Identifier: Apache-2.0
#include "checker/lint/lint.h"

#include <gtest/gtest.h>

#include "tests/checker/lint/drawn_domain.h"

namespace weft::check {
namespace {

TEST(Lint, ADomainOfNothingHasNoFaults) {
  EXPECT_EQ(DrawnDomain().told(), "");
}

TEST(Lint, FaultsComeByKindAndThenInTheOrderOfTheDomain) {
  DrawnDomain drawn;
  drawn.box({0, 0}, {9, 9}).line({{1, 1}, {3, 3}}).line({{1, 3}, {3, 1}});
  drawn.line({{5, 5}, {7, 7}}).line({{5, 7}, {7, 5}});
  drawn.ring({{0, 20}, {10, 20}, {10, 20.1}});
  const Faults faults = drawn.faults();
  ASSERT_EQ(drawn.told(), "open-end 8, crossing 2, small-angle 1");
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(faults.kept()[i].kind, FaultKind::kOpenEnd);
    EXPECT_EQ(faults.kept()[i].offenders.at(0).index, 4 + i / 2);
  }
  EXPECT_EQ(faults.kept().at(8).at, (Vec2{2, 2}));
  EXPECT_EQ(faults.kept().at(9).at, (Vec2{6, 6}));
  EXPECT_EQ(faults.kept().at(10).kind, FaultKind::kSmallAngle);
}

TEST(Lint, CountsWhatItDoesNotKeep) {
  DrawnDomain drawn;
  for (int i = 0; i < 600; ++i) drawn.line({{0, double(i)}, {1, double(i)}});
  const Faults faults = drawn.faults();
  EXPECT_EQ(faults.total(FaultKind::kOpenEnd), 1200U);
  EXPECT_EQ(faults.kept().size(), Faults::kMaxKept);
}

// Half a million crossings: the rest of the rules would take long.
TEST(Lint, EndsEarlyIfSegmentsMeetTooOften) {
  DrawnDomain drawn;
  for (int i = 0; i < 700; ++i)
    drawn.line({{-1, double(i)}, {701, double(i)}}).line({{double(i), -1}, {double(i), 701}});
  const LintResult result = lint(drawn.domain, false);
  EXPECT_FALSE(result.complete);
  EXPECT_GT(result.faults.total(FaultKind::kCrossing), 100'000U);
  EXPECT_EQ(result.faults.total(FaultKind::kOpenEnd), 0U);
}

// Places that are all near to each other are not compared pair by pair.
TEST(Lint, ACrowdTakesNoQuadraticTime) {
  DrawnDomain drawn;
  constexpr int kLines = 100'000;
  for (int i = 0; i < kLines; ++i) drawn.line({{0, 1e-9 * i}, {1, 1e-9 * i}});
  EXPECT_GE(drawn.faults().total(FaultKind::kGap), 100'000U);
}

}  // namespace
}  // namespace weft::check

// SPDX-License-Identifier: Apache-2.0
// Cancellation, deadline, budgets, limits.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numbers>
#include <random>

#include "engine/domain/domain.h"
#include "tests/engine/domain/shapes.h"
#include "tests/support/processor_time.h"

namespace weft {
namespace {

#ifdef WEFT_SANITIZED
const double kPromptly = 2;  // s; sanitizers slow the release of memory most
#else
const double kPromptly = 0.2 * slowdown();  // s
#endif

Pslg random_points(int n) {
  std::mt19937 random(7);
  Pslg pslg;
  add_box(pslg, {-1, -1}, {2, 2});
  for (int i = 0; i < n; ++i) {
    const double x = random() / 4294967296.0;
    pslg.points.push_back({x, random() / 4294967296.0});
  }
  return pslg;
}

Pslg hash(int n) {
  Pslg pslg = square(n + 1);
  for (int i = 1; i <= n; ++i) {
    add_segment(pslg, {0.5, i * 1.0}, {n + 0.5, i * 1.0});
    add_segment(pslg, {i * 1.0, 0.5}, {i * 1.0, n + 0.5});
  }
  return pslg;
}

ErrorCode stopped(const Pslg& pslg, const ExecutionContext& context) {
  const Result<Domain> domain = triangulate(pslg, context);
  return domain ? ErrorCode::kInternal : domain.error().code;
}

TEST(DomainStop, ACancelledJobDoesNoWork) {
  ExecutionContext context;
  context.cancel();
  EXPECT_EQ(stopped(square(), context), ErrorCode::kCancelled);
}

struct Stop {
  ErrorCode code;
  double late;  // s of the processor after the deadline
};

Stop stop_after(const Pslg& pslg, double seconds) {
  ExecutionContext context;
  const double start = processor_seconds();
  context.set_deadline(ExecutionContext::Clock::now() +
                       std::chrono::duration_cast<ExecutionContext::Clock::duration>(
                           std::chrono::duration<double>(seconds)));
  const ErrorCode code = stopped(pslg, context);
  return {code, processor_seconds() - start - seconds};
}

// Stops soon after the deadline, or ends before it. Others on the machine may slow down one try.
ErrorCode expect_prompt_stop(const Pslg& pslg, double seconds) {
  SCOPED_TRACE(seconds);
  Stop stop = stop_after(pslg, seconds);
  for (int again = 0; again < 3 && stop.late > kPromptly; ++again) stop = stop_after(pslg, seconds);
  EXPECT_LE(stop.late, kPromptly);
  return stop.code;
}

void expect_prompt_stops(const Pslg& pslg) {
  for (double seconds = 0.005; seconds < 0.1; seconds *= 2)
    EXPECT_EQ(expect_prompt_stop(pslg, seconds), ErrorCode::kDeadlineExceeded);
}

// After so many tenths of the time that the whole takes.
void expect_prompt_stops(const Pslg& pslg, std::initializer_list<int> tenths) {
  const ExecutionContext context;
  const double start = processor_seconds();
  ASSERT_TRUE(triangulate(pslg, context));
  const double whole = processor_seconds() - start;
  for (const int tenth : tenths) expect_prompt_stop(pslg, whole * tenth / 10);
}

// A million where nothing slows it down.
#ifdef WEFT_SANITIZED
constexpr int kMany = 200'000;
#else
constexpr int kMany = 1'000'000;
#endif

TEST(DomainStop, TheDeadlineEndsTheInsertionOfPointsInTime) {
  expect_prompt_stops(random_points(kMany));
}

TEST(DomainStop, TheDeadlineEndsEachLaterStageInTime) {
  expect_prompt_stops(random_points(kMany), {5, 7, 8, 9});
}

TEST(DomainStop, TheDeadlineEndsTheWorkAtAHubInTime) {
  Pslg pslg;
  add_box(pslg, {-2, -2}, {2, 2});
  pslg.points.push_back({0, 0});
  for (int i = 0; i < kMany; ++i) {
    const double angle = 2 * std::numbers::pi * i / kMany;
    pslg.points.push_back({std::cos(angle), std::sin(angle)});
  }
  expect_prompt_stops(pslg, {2, 4, 6});
}

TEST(DomainStop, TheDeadlineEndsALongDigInTime) {
  // The segment crosses as many edges as there are points.
  Pslg pslg;
  add_box(pslg, {-1, -9}, {kMany / 2.0 + 2, 9});
  std::mt19937 random(7);
  for (int i = 1; i <= kMany / 2; ++i) {
    pslg.points.push_back({i + 0.4 * random() / 4294967296.0, 0.1 + random() / 4294967296.0});
    pslg.points.push_back({i + 0.4 * random() / 4294967296.0, -0.1 - random() / 4294967296.0});
  }
  add_segment(pslg, {0, 0}, {kMany / 2.0 + 1, 0});
  expect_prompt_stops(pslg, {5, 6, 7});
}

TEST(DomainStop, TheDeadlineEndsTheInsertionOfSegmentsInTime) {
  expect_prompt_stops(hash(400));
}

TEST(DomainStop, PointsOverTheByteBudgetAreRefusedBeforeWork) {
  const ExecutionContext context(Budget{.max_bytes = 1000});
  const Result<Domain> domain = triangulate(square(), context);
  ASSERT_FALSE(domain);
  EXPECT_EQ(domain.error().code, ErrorCode::kBudgetExceeded);
  EXPECT_EQ(domain.error().message,
            "triangulating the domain takes about 1120 bytes with all that the run holds, the "
            "budget is 1000");
}

TEST(DomainStop, CrossingsOverTheByteBudgetAreRefused) {
  // 2,500 crossings of 104 segments.
  const ExecutionContext context(Budget{.max_bytes = 500000});
  EXPECT_EQ(stopped(hash(50), context), ErrorCode::kBudgetExceeded);
}

}  // namespace
}  // namespace weft

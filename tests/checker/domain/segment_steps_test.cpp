// SPDX-License-Identifier: Apache-2.0
// Paths of listed edges along one segment.
#include "checker/domain/segment_steps.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace weft::check::testing {
namespace {

// Vertex v is at position v.
Step step(std::uint32_t from, std::uint32_t to, std::uint32_t edge) {
  return {0, static_cast<double>(from), static_cast<double>(to), from, to, edge};
}

TEST(SegmentSteps, AWalkFollowsStepsFromStartToGoal) {
  const std::vector<Step> steps = {step(0, 2, 0), step(0, 3, 1), step(1, 4, 2), step(3, 4, 3)};
  EXPECT_EQ(walk(steps, 0, 0, 4).path, (std::vector<std::size_t>{3, 1}));
  const Walk broken = walk(steps, 0, 0, 5);
  EXPECT_TRUE(broken.path.empty());
  EXPECT_EQ(broken.farthest, 4u);
  EXPECT_EQ(walk(steps, 2, 2, 5).farthest, 2u) << "no step leads on";
}

TEST(SegmentSteps, TheFirstPairIsTheOneThatAPathJoins) {
  const std::vector<Step> steps = {step(0, 2, 0), step(1, 4, 1), step(2, 3, 2)};
  const std::vector<std::uint32_t> starts{1, 0}, goals{3, 4};
  EXPECT_EQ(first_joined(steps, starts, goals), (std::array{1u, 4u}));
  EXPECT_EQ(first_joined(steps, std::vector{0u}, goals), (std::array{0u, 3u}));
  EXPECT_EQ(first_joined(steps, std::vector{4u}, goals), std::nullopt);
  EXPECT_EQ(first_joined(steps, std::vector{3u}, std::vector{3u}), std::nullopt) << "one vertex";
}

// From vertex 0 to each of the others, and from each of these to the last: all that was reached is
// ahead all the time. A search through it at each step takes minutes.
TEST(SegmentSteps, AFanTakesLinearTime) {
  constexpr std::uint32_t kTeeth = 500'000;
  constexpr std::uint32_t kGoal = kTeeth + 1;
  std::vector<Step> steps;
  for (std::uint32_t v = 1; v <= kTeeth; ++v) steps.push_back(step(0, v, v));
  for (std::uint32_t v = 2; v <= kTeeth; ++v) steps.push_back(step(v, kGoal, kTeeth + v));
  EXPECT_EQ(walk(steps, 0, 0, kGoal).path.size(), 2u);
  EXPECT_EQ(walk(steps, 0, 0, kGoal + 1).farthest, kGoal);
  std::vector<std::uint32_t> starts, goals;
  for (std::uint32_t i = 0; i < 16; ++i) {
    starts.push_back(kGoal + i);
    goals.push_back(kGoal + 20 + i);
  }
  EXPECT_EQ(first_joined(steps, starts, goals), std::nullopt);
}

}  // namespace
}  // namespace weft::check::testing

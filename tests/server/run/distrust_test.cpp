// SPDX-License-Identifier: Apache-2.0
#include "server/run/distrust.h"

#include <gtest/gtest.h>

namespace weft::server {
namespace {

using std::chrono::minutes;
using std::chrono::seconds;

constexpr Distrust::Clock::time_point kBegin{};

// How long it holds from `now` on, in whole seconds.
std::int64_t seconds_of(const Distrust& distrust, Distrust::Clock::time_point now) {
  std::int64_t held = 0;
  while (distrust.holds_for("a", now + seconds(held))) ++held;
  return held;
}

TEST(Distrust, HoldsForAWhileAndForOneClientAlone) {
  Distrust distrust(seconds(10));
  EXPECT_EQ(seconds_of(distrust, kBegin), 0);
  distrust.turned_out_heavy("a", kBegin);
  EXPECT_EQ(seconds_of(distrust, kBegin), 10);
  EXPECT_FALSE(distrust.holds_for("b", kBegin));
}

TEST(Distrust, HoldsForTwiceAsLongEachTimeUpToABound) {
  Distrust distrust(seconds(10));
  auto now = kBegin;
  for (const std::int64_t expected : {10, 20, 40, 80, 160, 320, 600, 600}) {
    distrust.turned_out_heavy("a", now);
    EXPECT_EQ(seconds_of(distrust, now), expected);
    now += seconds(expected);
  }
}

TEST(Distrust, IsNotProlongedByWhatBeganBefore) {
  Distrust distrust(seconds(10));
  distrust.turned_out_heavy("a", kBegin);
  distrust.turned_out_heavy("a", kBegin + seconds(9));
  EXPECT_EQ(seconds_of(distrust, kBegin), 10);
}

TEST(Distrust, ForgetsAClientThatBehavesForAsLongAsItHeld) {
  Distrust distrust(seconds(10));
  distrust.turned_out_heavy("a", kBegin);
  distrust.turned_out_heavy("a", kBegin + seconds(20));
  EXPECT_EQ(seconds_of(distrust, kBegin + seconds(20)), 10);
  distrust.turned_out_heavy("a", kBegin + seconds(49));
  EXPECT_EQ(seconds_of(distrust, kBegin + seconds(49)), 10) << "20 s after its end";
}

}  // namespace
}  // namespace weft::server

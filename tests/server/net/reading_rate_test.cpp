// SPDX-License-Identifier: Apache-2.0
#include "server/net/reading_rate.h"

#include <gtest/gtest.h>

namespace weft::server::testing {
namespace {

using std::chrono::seconds;

constexpr ReaderPatience kSlowest{.stall_timeout = seconds(60), .least_rate = 100};

TEST(ReadingRate, IsJudgedOnAverageOverTheTimeThatSomethingWaits) {
  const ReadingRate::Clock::time_point begin{};
  ReadingRate rate;
  EXPECT_FALSE(rate.too_slow(begin + seconds(600), kSlowest)) << "nothing waits";
  rate.start(begin);
  rate.add(6'000);
  EXPECT_FALSE(rate.too_slow(begin + seconds(59), kSlowest));
  EXPECT_FALSE(rate.too_slow(begin + seconds(60), kSlowest));
  rate.start(begin + seconds(119));  // still the same
  rate.add(5'999);
  EXPECT_FALSE(rate.too_slow(begin + seconds(119), kSlowest)) << "anew since the first judgement";
  EXPECT_EQ(rate.too_slow(begin + seconds(120), kSlowest),
            "the client read 5999 bytes in 60.0 s; this server's least rate is 100 a second");
}

TEST(ReadingRate, IsNoMatterWhileNothingWaits) {
  const ReadingRate::Clock::time_point begin{};
  ReadingRate rate;
  rate.start(begin);
  rate.rest();
  rate.start(begin + seconds(59));
  EXPECT_FALSE(rate.too_slow(begin + seconds(118), kSlowest));
  EXPECT_TRUE(rate.too_slow(begin + seconds(119), kSlowest));
  rate.start(begin);
  EXPECT_FALSE(rate.too_slow(begin + seconds(600), {.least_rate = 0}));
}

}  // namespace
}  // namespace weft::server::testing

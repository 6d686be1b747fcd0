// SPDX-License-Identifier: Apache-2.0
#include "server/observe/bounded_log.h"

#include <gtest/gtest.h>

#include <chrono>

#include "tests/server/logged_server.h"

namespace weft::server::testing {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(BoundedLog, TellsHowManyLinesWereLeftOut) {
  Log log;
  BoundedLog refusals(log.logger(), "call_refused", 2);
  const BoundedLog::Clock::time_point start{seconds(100)};
  int taken = 0;
  for (int i = 0; i < 10; ++i) taken += refusals.allow(start + milliseconds(10 * i));
  EXPECT_EQ(taken, 2);
  refusals.flush_suppressed(start + milliseconds(999));
  EXPECT_EQ(log.text(), "");
  refusals.flush_suppressed(start + seconds(1));
  EXPECT_EQ(log.text(), "event=lines_left_out count=8 of=call_refused\n");
  EXPECT_TRUE(refusals.allow(start + seconds(1)));
  refusals.flush_suppressed(start + seconds(3));
  EXPECT_EQ(log.text(), "event=lines_left_out count=8 of=call_refused\n") << "none since";
}

}  // namespace
}  // namespace weft::server::testing

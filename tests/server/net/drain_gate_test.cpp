// SPDX-License-Identifier: Apache-2.0
#include "server/net/drain_gate.h"

#include <gtest/gtest.h>

#include <thread>

namespace weft::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(DrainGate, AClosedGateAdmitsNobody) {
  DrainGate gate;
  EXPECT_TRUE(gate.enter());
  gate.close();
  EXPECT_FALSE(gate.enter());
}

TEST(DrainGate, WaitsForThoseInside) {
  DrainGate gate;
  std::optional<DrainGate::Pass> pass = gate.enter();
  EXPECT_FALSE(gate.wait_empty(milliseconds(1)));
  std::thread leaver([&] { pass.reset(); });
  EXPECT_TRUE(gate.wait_empty(seconds(30)));
  leaver.join();
}

TEST(DrainGate, APassThatMovedLeavesOnce) {
  DrainGate gate;
  std::optional<DrainGate::Pass> other = gate.enter();
  {
    std::optional<DrainGate::Pass> pass = gate.enter();
    const DrainGate::Pass moved(std::move(*pass));
  }
  EXPECT_FALSE(gate.wait_empty(milliseconds(1)));
  other.reset();
  EXPECT_TRUE(gate.wait_empty(seconds(30)));
}

}  // namespace
}  // namespace weft::server

// SPDX-License-Identifier: Apache-2.0
#include "server/memory_gate.h"

#include <gtest/gtest.h>

namespace weft::server {
namespace {

TEST(MemoryGate, AdmitsWhatFitsAndNoMore) {
  MemoryGate gate(100, [] {});
  const auto first = gate.take(60);
  ASSERT_TRUE(first);
  EXPECT_FALSE(gate.take(41));
  EXPECT_EQ(gate.room(), 40);
  const auto second = gate.take(40);
  EXPECT_TRUE(second);
  EXPECT_EQ(gate.taken(), 100);
}

TEST(MemoryGate, AdmitsWhoeverIsAloneHoweverHeavy) {
  MemoryGate gate(100, [] {});
  const auto heavy = gate.take(1000);
  ASSERT_TRUE(heavy);
  EXPECT_EQ(gate.room(), 0);
  EXPECT_FALSE(gate.take(1));
}

TEST(MemoryGate, TakesBackASharesBytesOnceAndSaysSo) {
  int told = 0;
  MemoryGate gate(100, [&] { ++told; });
  {
    auto share = gate.take(60);
    const auto moved = std::move(*share);
    EXPECT_EQ(gate.taken(), 60);
  }
  EXPECT_EQ(gate.taken(), 0);
  EXPECT_EQ(told, 1);
  EXPECT_TRUE(gate.take(1000));
}

}  // namespace
}  // namespace weft::server

// SPDX-License-Identifier: Apache-2.0
#include "server/console/byte_budget.h"

#include <gtest/gtest.h>

namespace weft::server::testing {
namespace {

TEST(ByteBudget, HasBackWhatIsNoLongerHeld) {
  ByteBudget budget(10);
  ByteBudget::Held other(budget, "bob");
  {
    ByteBudget::Held held(budget, "ann");
    EXPECT_TRUE(held.hold(8));
    EXPECT_FALSE(held.hold(11));
    EXPECT_EQ(held.bytes(), 8u);
    EXPECT_TRUE(held.hold(4));
    EXPECT_TRUE(other.hold(6));
    EXPECT_FALSE(other.hold(7));
  }
  EXPECT_TRUE(other.hold(10));
}

TEST(ByteBudget, BoundsWhatOneClientHoldsInSeveralHoldings) {
  ByteBudget budget(12, 0.75);
  ByteBudget::Held bob(budget, "bob");
  {
    ByteBudget::Held only(budget, "ann");
    EXPECT_TRUE(only.hold(12)) << "the only one has what there is";
    EXPECT_TRUE(only.hold(5));
    ByteBudget::Held second(budget, "ann");
    EXPECT_FALSE(second.hold(5));
    EXPECT_TRUE(second.hold(4));
    EXPECT_FALSE(only.hold(6));
    EXPECT_TRUE(bob.hold(3));
    EXPECT_FALSE(bob.hold(4));
  }
  ByteBudget::Held again(budget, "ann");
  EXPECT_TRUE(again.hold(9));
}

}  // namespace
}  // namespace weft::server::testing

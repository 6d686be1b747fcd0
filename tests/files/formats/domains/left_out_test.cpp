// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/left_out.h"

#include <gtest/gtest.h>

namespace weft::files {
namespace {

TEST(LeftOut, IsOneSentenceThatCountsAndNamesTheFirst) {
  LeftOut left_out;
  EXPECT_EQ(left_out.sentence(), "");
  left_out.add(LeftOut::kLine, "a[1]");
  EXPECT_EQ(left_out.sentence(), "1 line without a length is left out: a[1]");
  left_out.add(LeftOut::kLine, "a[2]");
  EXPECT_EQ(left_out.sentence(), "2 lines without a length are left out, the first is a[1]");
  left_out.add(LeftOut::kRing, "a[3]");
  EXPECT_EQ(left_out.sentence(),
            "1 ring without an area and 2 lines without a length are left out, the first is a[1]");
  left_out.add(LeftOut::kGeometry, "a[4]");
  EXPECT_EQ(left_out.sentence(),
            "1 ring without an area, 2 lines without a length and 1 empty geometry are left "
            "out, the first is a[1]");
}

}  // namespace
}  // namespace weft::files

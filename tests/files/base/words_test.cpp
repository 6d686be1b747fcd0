// SPDX-License-Identifier: Apache-2.0
#include "files/base/words.h"

#include <gtest/gtest.h>

namespace weft::files {
namespace {

TEST(Words, AreTrimmedOfBlanks) {
  EXPECT_EQ(trimmed(" \ta b\r\n"), "a b");
  EXPECT_EQ(trimmed(" \t"), "");
  EXPECT_EQ(trimmed(""), "");
}

TEST(Words, AreInLowerCaseButForLettersThatAreNotAscii) {
  EXPECT_EQ(lower_case("WKT_geom 1\u00c4"), "wkt_geom 1\u00c4");
}

}  // namespace
}  // namespace weft::files

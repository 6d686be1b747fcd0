// SPDX-License-Identifier: Apache-2.0
#include "files/bytes/number_text.h"

#include <gtest/gtest.h>

namespace weft::files {
namespace {

TEST(NumberText, IsReadAsCWritesIt) {
  EXPECT_EQ(real_of("4"), 4);
  EXPECT_EQ(real_of("+.5"), 0.5);
  EXPECT_EQ(real_of("-4."), -4);
  EXPECT_EQ(real_of("4e3"), 4000);
  EXPECT_EQ(real_of("4E-3"), 0.004);
  EXPECT_EQ(real_of("5e-324"), 5e-324);
}

TEST(NumberText, IsReadAsFortranWritesIt) {
  EXPECT_EQ(real_of("1.0D+03"), 1000);
  EXPECT_EQ(real_of("-1.D3"), -1000);
  EXPECT_EQ(real_of(".25d-2"), 0.0025);
  EXPECT_EQ(real_of("1.0+103"), 1e103);
  EXPECT_EQ(real_of("-0.25-103"), -0.25e-103);
}

TEST(NumberText, IsANumberAsAWholeOrNotAtAll) {
  for (const char* text : {"",         "+",         "-",          ".",    "4x",  "4.0D",   "4.0D+",
                           "4.0DD3",   "1D2D3",     "D3",         "x",    "4 ",  " 4",     "0x10",
                           "1,5",      "+-4",       "1e",         "4.0+", "1-2", "10+103", "1.0+3",
                           "1.0+1034", "1.0e5+103", "2024-11-25", "inf",  "nan", "1e999",  "1D999"})
    EXPECT_EQ(real_of(text), std::nullopt) << text;
}

TEST(NumberText, IsZeroIfItIsTooSmall) {
  EXPECT_EQ(real_of("1e-999"), 0);
  EXPECT_EQ(real_of("1E-999"), 0);
  EXPECT_EQ(real_of("1D-999"), 0);
}

TEST(NumberText, MayHaveADecimalComma) {
  EXPECT_EQ(real_with_comma_of("0,5"), 0.5);
  EXPECT_EQ(real_with_comma_of("-1,5D1"), -15);
  EXPECT_EQ(real_with_comma_of("0.5"), 0.5);
  for (const char* text : {"1.234,5", "1,234.5", "1,2,3", ",", ""})
    EXPECT_EQ(real_with_comma_of(text), std::nullopt) << text;
}

TEST(NumberText, IsAnIntegerIfItIsWhole) {
  EXPECT_EQ(integer_of("+7"), 7);
  EXPECT_EQ(integer_of("-7"), -7);
  for (const char* text : {"", "+", "+-7", "7.0", "7x", "99999999999999999999"})
    EXPECT_EQ(integer_of(text), std::nullopt) << text;
}

}  // namespace
}  // namespace weft::files

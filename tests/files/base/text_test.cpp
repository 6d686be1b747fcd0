// SPDX-License-Identifier: Apache-2.0
#include "files/base/text.h"

#include <gtest/gtest.h>

namespace weft::files {
namespace {

TEST(Text, QuotesWhatIsNotPrintableAndShortensWhatIsLong) {
  EXPECT_EQ(in_quotes("a\n\xff"), "'a\\x0a\\xff'");
  EXPECT_EQ(in_quotes(std::string(40, 'x')), "'" + std::string(32, 'x') + "...'");
}

TEST(Text, QuotesUpTo24Texts) {
  std::vector<std::string> texts(24, "a");
  EXPECT_EQ(in_quotes(std::vector<std::string>{"a", "b\n"}), "'a', 'b\\x0a'");
  EXPECT_FALSE(in_quotes(texts).ends_with("..."));
  texts.emplace_back("b");
  EXPECT_TRUE(in_quotes(texts).ends_with("'a', ..."));
}

TEST(Text, SeparatesThousands) {
  EXPECT_EQ(with_separators(0), "0");
  EXPECT_EQ(with_separators(999), "999");
  EXPECT_EQ(with_separators(1000), "1,000");
  EXPECT_EQ(with_separators(18446744073709551615u), "18,446,744,073,709,551,615");
}

TEST(Text, WritesNumbersThatReadBack) {
  EXPECT_EQ(shortest(0.1), "0.1");
  EXPECT_EQ(coordinates(-1, 1e300), "(-1, 1e+300)");
}

TEST(Text, RoundsUpToTwoDigits) {
  EXPECT_EQ(two_digits_above(0.0156), "0.016");
  EXPECT_EQ(two_digits_above(0.01), "0.011");
  EXPECT_EQ(two_digits_above(99.5), "100");
  EXPECT_EQ(two_digits_above(1234), "1300");
  EXPECT_EQ(two_digits_above(1e-9), "1.1e-09");
}

TEST(Text, WritesBytesAsHexadecimal) {
  EXPECT_EQ(hex(std::string_view("\x00\xab", 2)), "00ab");
}

}  // namespace
}  // namespace weft::files

// SPDX-License-Identifier: Apache-2.0
#include "files/bytes/line_scanner.h"

#include <gtest/gtest.h>

namespace weft::files {
namespace {

// The reals of a line, or the error at the first that is none.
std::string reals_of(std::string_view line, LineSyntax syntax = {}) {
  LineScanner scanner("d.txt", line, syntax);
  std::string out;
  if (!scanner.try_next_line()) return "";
  while (!scanner.at_line_end()) {
    const auto value = scanner.real("a number");
    if (!value) return value.error().message;
    out += (out.empty() ? "" : " ") + std::to_string(static_cast<int>(*value * 100));
  }
  return out;
}

TEST(LineScanner, ReadsNumbersBetweenBlanksAndCommas) {
  EXPECT_EQ(reals_of("1 0.5\t2\r\n"), "100 50 200");
  EXPECT_EQ(reals_of("1,0.5,2"), "100 50 200");
  EXPECT_EQ(reals_of("1,2,3"), "100 200 300");
  EXPECT_EQ(reals_of("1, 2, 3"), "100 200 300");
  EXPECT_EQ(reals_of("1 0.5,0.25"), "100 50 25");
  EXPECT_EQ(reals_of("1 4.0D-01 # 0,5"), "100 40");
}

TEST(LineScanner, RefusesANumberThatMayHaveADecimalComma) {
  const std::string end =
      " before another number: write a decimal point, or blanks alone between numbers";
  EXPECT_EQ(reals_of("1 0,5 0,5"),
            "d.txt:1:3: a number may be '0,5' with a decimal comma, or '0'" + end);
  EXPECT_EQ(reals_of("10,5 2"),
            "d.txt:1:1: a number may be '10,5' with a decimal comma, or '10'" + end);
  EXPECT_EQ(reals_of("1 2 -0,25"),
            "d.txt:1:5: a number may be '-0,25' with a decimal comma, or '-0'" + end);
}

TEST(LineScanner, RefusesACommaIfItIsNoBlank) {
  EXPECT_EQ(reals_of("0,5", {.blanks = " "}), "d.txt:1:1: expected a number, found '0,5'");
}

TEST(LineScanner, TellsNumbersThatAreNotFiniteFromWords) {
  EXPECT_EQ(reals_of("nan"), "d.txt:1:1: expected a number, a finite number, found 'nan'");
  EXPECT_EQ(reals_of("1e999"), "d.txt:1:1: expected a number, a finite number, found '1e999'");
  EXPECT_EQ(reals_of("4.0Dx"), "d.txt:1:1: expected a number, found '4.0Dx'");
}

}  // namespace
}  // namespace weft::files

// SPDX-License-Identifier: Apache-2.0
#include "files/bytes/node_numbers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace weft::files {
namespace {

// Takes the numbers of the first line for those of points, then reads those of the second; returns
// indices, or the error.
std::string indices(std::string_view text) {
  LineScanner scanner("d.txt", text);
  NodeNumbers numbers;
  if (!scanner.try_next_line()) return "";
  while (!scanner.at_line_end())
    if (auto added = numbers.add(scanner, "the node number"); !added) return added.error().message;
  std::string out;
  if (!scanner.try_next_line()) return "";
  while (!scanner.at_line_end()) {
    const auto index = numbers.read(scanner, "a corner");
    if (!index) return index.error().message;
    out += std::to_string(*index);
  }
  return out;
}

TEST(NodeNumbers, CountFromAnyNumber) {
  EXPECT_EQ(indices("1 2 3\n3 1 2"), "201");
  EXPECT_EQ(indices("0 1 2\n0 2"), "02");
  EXPECT_EQ(indices("-1 0 1\n0 -1"), "10");
}

TEST(NodeNumbers, HaveAnyOrder) {
  EXPECT_EQ(indices("9 3 5\n5 9 3"), "201");
  EXPECT_EQ(indices("1 2 4 3\n4 3 2"), "231");
  EXPECT_EQ(indices("9223372036854775807 -9223372036854775808\n-9223372036854775808"), "1");
}

TEST(NodeNumbers, AreThoseOfOnePointEach) {
  EXPECT_EQ(indices("1 2 2\n"),
            "d.txt:1:5: the node number is 2, as that of another one before it");
  EXPECT_EQ(indices("5 1 5\n"),
            "d.txt:1:5: the node number is 5, as that of another one before it");
}

// Of points with the numbers of a line, the indices of those in a range.
std::string in_range(std::string_view text, std::int64_t first, std::int64_t last,
                     std::int64_t step) {
  LineScanner scanner("d.txt", text);
  NodeNumbers numbers;
  if (!scanner.try_next_line()) return "";
  while (!scanner.at_line_end())
    if (!numbers.add(scanner, "the node number")) return "";
  std::string out;
  numbers.each_of(first, last, step, [&out](std::uint32_t i) { out += std::to_string(i); });
  std::sort(out.begin(), out.end());
  return out;
}

TEST(NodeNumbers, AreFoundInRangesHoweverWide) {
  constexpr std::int64_t kMin = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
  EXPECT_EQ(in_range("5 6 7 8", 5, 8, 1), "0123");
  EXPECT_EQ(in_range("5 6 7 8", 6, 9, 2), "13");
  EXPECT_EQ(in_range("5 6 7 8", 8, 5, 1), "");
  EXPECT_EQ(in_range("5 6 7 8", kMin, kMax, 2), "13");
  EXPECT_EQ(in_range("5 6 7 8", kMin, kMax, kMax), "");
  EXPECT_EQ(in_range("5 6 7 8", 6, kMax, kMax - 7), "1");
  EXPECT_EQ(in_range("9 -3 9223372036854775807", kMin, kMax, 1), "012");
  EXPECT_EQ(in_range("9 -3 9223372036854775807", -3, 21, 12), "01");
}

TEST(NodeNumbers, TellWhichThereAre) {
  EXPECT_EQ(indices("1 2 3\n4"), "d.txt:2:1: a corner is 4, the numbers run from 1 to 3");
  EXPECT_EQ(indices("3 9 5\n4"),
            "d.txt:2:1: a corner is 4, which no point has; the numbers are from 3 to 9");
}

}  // namespace
}  // namespace weft::files

// SPDX-License-Identifier: Apache-2.0
#include "files/formats/warning.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace weft::files {
namespace {

TEST(Warning, NamesItsFileAndLineInItsSentence) {
  Warning warning{.kind = WarningKind::kRow, .text = "a row is odd"};
  EXPECT_EQ(warning.sentence(), "a row is odd");
  warning.file = "a.csv";
  EXPECT_EQ(warning.sentence(), "a.csv: a row is odd");
  warning.line = 7;
  EXPECT_EQ(warning.sentence(), "a.csv:7: a row is odd");
}

TEST(Warning, HasANameForEachKind) {
  std::set<std::string_view> names;
  constexpr int kKinds = static_cast<int>(WarningKind::kOpenBoundary) + 1;
  for (int kind = 0; kind < kKinds; ++kind)
    names.insert(warning_name(static_cast<WarningKind>(kind)));
  EXPECT_EQ(names.size(), kKinds);
  EXPECT_FALSE(names.contains(""));
}

}  // namespace
}  // namespace weft::files

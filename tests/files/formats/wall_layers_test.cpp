// SPDX-License-Identifier: Apache-2.0
#include "files/formats/wall_layers.h"

#include <gtest/gtest.h>

namespace weft::files {
namespace {

TEST(WallLayers, IsReadFromText) {
  const auto full = WallLayers::parse("wall:region=-3,rows=20,ratio=1.2,first=1e-5");
  ASSERT_TRUE(full);
  EXPECT_EQ(full->marker, "wall");
  EXPECT_EQ(full->first, 1e-5);
  EXPECT_EQ(full->ratio, 1.2);
  EXPECT_EQ(full->rows, 20u);
  EXPECT_EQ(full->region, -3);
  EXPECT_FALSE(WallLayers::parse("4:first=1,rows=2")->region);
  for (const char* text : {"", "wall", ":first=1,rows=2", "wall:", "wall:first=1", "wall:rows=2",
                           "wall:first=1,rows=2,", "wall:first=1,rows=-2", "wall:first=nan,rows=2",
                           "wall:first=inf,rows=2", "wall:first=1,rows=2,height=3",
                           "wall:first=1,rows=2.5", "wall:first,rows=2"})
    EXPECT_FALSE(WallLayers::parse(text)) << text;
}

TEST(WallLayers, HaveTheNumberOfTheirMarker) {
  const auto number = [](const char* marker) { return WallLayers{marker}.number({{3, "wall"}}); };
  EXPECT_EQ(number("wall").value(), 3);
  EXPECT_EQ(number("-4").value(), -4);
  EXPECT_EQ(number("wal").error().message,
            "no marker of the domain is named 'wal': did you mean `wall`?");
}

}  // namespace
}  // namespace weft::files

// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/attribute_condition.h"

#include <gtest/gtest.h>

namespace weft::files {
namespace {

constexpr std::string_view kNames[] = {"Layer", "depth", "nothing"};

AttributeValue value(std::size_t attribute) {
  if (attribute == 0) return std::string("Wall's");
  if (attribute == 1) return 4.5;
  return {};
}

bool holds(const std::string& text) {
  const auto condition = AttributeCondition::parse(text, kNames);
  EXPECT_TRUE(condition) << text << ": " << condition.error().message;
  return condition && condition->holds(value);
}

std::string fault(const std::string& text) {
  const auto condition = AttributeCondition::parse(text, kNames);
  return condition ? "" : condition.error().message;
}

TEST(AttributeCondition, IsThatOfSql) {
  for (const char* text :
       {"", "Layer = 'wall''s'", "\"LAYER\" <> 'x'", "depth>=4.5 and depth <= 4.5", "depth = '4.5'",
        "depth IN (1, 4.5)", "Layer NOT IN ('a','b')", "layer like 'W_ll%'", "layer ilike '%WALL%'",
        "not layer like 'w%'", "depth between 4 and 5", "depth not between 5 and 6",
        "nothing is null", "depth IS NOT NULL", "(depth < 1 or depth > 4) and not (layer = 'x')",
        "depth = 1 or depth > 4 and depth < 5", "-1 < depth", "layer like '%%s'",
        "nothing = 1 or depth > 1"})
    EXPECT_TRUE(holds(text)) << text;
  for (const char* text :
       {"layer = 'x'", "depth != 4.5", "nothing = 1", "not nothing = 1", "nothing <> 1",
        "nothing in (1)", "nothing not in (1)", "nothing like '%'", "layer like 'wall''s'",
        "depth = 'deep'", "depth between 5 and 6", "nothing = 1 and depth > 1"})
    EXPECT_FALSE(holds(text)) << text;
}

TEST(AttributeCondition, IsRefusedWithWhatIsExpected) {
  EXPECT_EQ(fault("height = 1"), "there is no attribute 'height'");
  EXPECT_EQ(fault("depth"), "expected a comparison, found the end");
  EXPECT_EQ(fault("depth = "), "expected an attribute, a number or a text, found the end");
  EXPECT_EQ(fault("depth = 1 2"), "expected AND, OR or the end, found '2'");
  EXPECT_EQ(fault("(depth = 1"), "expected ')', found the end");
  EXPECT_EQ(fault("layer = 'x"), "a quotation mark is not closed");
  EXPECT_EQ(fault("depth = 1.2.3"), "expected an attribute, a number or a text, found '1.2.3'");
  EXPECT_EQ(fault("layer like 3"), "expected a text, found '3'");
  EXPECT_EQ(fault("depth not = 3"), "expected IN, LIKE, ILIKE or BETWEEN, found '='");
  EXPECT_EQ(fault(std::string(100, '(')), "is nested deeper than 64 levels");
}

}  // namespace
}  // namespace weft::files

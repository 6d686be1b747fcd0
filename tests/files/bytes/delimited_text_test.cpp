// SPDX-License-Identifier: Apache-2.0
#include "files/bytes/delimited_text.h"

#include <gtest/gtest.h>

namespace weft::files {
namespace {

using Kind = DelimitedText::Record::Kind;

// Names, then records: fields between '|', each record in a line; or the error.
std::string records(std::string_view text) {
  DelimitedText table("d.csv", text);
  if (auto begun = table.begin(); !begun) return begun.error().message;
  std::string out;
  for (const std::string& name : table.names()) out += name + "!";
  for (;;) {
    const auto record = table.next();
    if (!record) return record.error().message;
    if (!*record) return out;
    out += "\n" + std::to_string((*record)->line) + ":";
    if ((*record)->kind == Kind::kMark) out += ">";
    if ((*record)->kind == Kind::kFields)
      for (const auto& field : (*record)->fields) out += field.value() + "|";
  }
}

TEST(DelimitedText, HasFieldsInQuotationMarks) {
  EXPECT_EQ(records("a,b\n\"x, \"\"y\"\"\n#z\",2\n3,4\n"), "a!b!\n2:x, \"y\"\n#z|2|\n4:3|4|");
  EXPECT_EQ(records("1,6\" pipe\n"), "\n1:1|6\" pipe|");
}

TEST(DelimitedText, RefusesAQuotationMarkThatIsNotClosed) {
  EXPECT_EQ(records("1,\"a\n2,\"b\n"),
            "d.csv:1:3: the quotation mark is not closed before a separator");
}

TEST(DelimitedText, HasCommentsAtTheStartOfAFieldOrAfterABlank) {
  EXPECT_EQ(records("# a \"b\n1,2 # c;d\n3,#4\n5,6#7\n"), "\n1:\n2:1|2|\n3:3||\n4:5|6#7|");
}

TEST(DelimitedText, HasBlankLinesOfSeparatorsAlone) {
  EXPECT_EQ(records(";;\n1;2;3\n ; \t;\n"), "\n1:\n2:1|2|3|\n3:");
}

TEST(DelimitedText, HasMarksOfWhichTheTextSaysNothing) {
  EXPECT_EQ(records("> a;b \"c\n1 2\n  >\n"), "\n1:>\n2:1|2|\n3:>");
}

TEST(DelimitedText, ReadsNumbersByItsSeparator) {
  const auto first = [](std::string_view text) {
    DelimitedText table("d.csv", text);
    EXPECT_TRUE(table.begin());
    const auto record = table.next();
    return record && *record ? table.real((*record)->fields.at(0)) : std::nullopt;
  };
  EXPECT_EQ(first("1,5;2\n"), 1.5);
  EXPECT_EQ(first("1,5 2\n"), 1.5);
  EXPECT_EQ(first("1,5\n"), 1);
  EXPECT_EQ(first("\"1,5\",2\n"), 1.5);
}

TEST(DelimitedText, KnowsWhatStandsForNoNumber) {
  for (const char* text : {"NaN", "nan", "-NAN", "NA", "1.#QNAN", "-1.#IND", "-nan(ind)"})
    EXPECT_TRUE(is_nan_text(text)) << text;
  for (const char* text : {"", "-", "n", "nano", "0", "inf"})
    EXPECT_FALSE(is_nan_text(text)) << text;
}

}  // namespace
}  // namespace weft::files

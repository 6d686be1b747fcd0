// SPDX-License-Identifier: Apache-2.0
#include "files/bytes/code_page.h"

#include <gtest/gtest.h>

namespace weft::files {
namespace {

TEST(CodePage, IsNamedByAFileOrByTheHeader) {
  for (const char* page : {"", "1252", " 1252\n", "CP1252", "ANSI 1252", "88591", "ISO-8859-1",
                           "LDID/87", "LDID/3", "LDID/0"})
    EXPECT_EQ(to_utf8("K\xfcste", page), "Küste") << page;
  EXPECT_EQ(to_utf8("K\x81ste", "850"), "Küste");
  EXPECT_EQ(to_utf8("K\x81ste", "LDID/2"), "Küste");
  EXPECT_EQ(to_utf8("\xf0\xe5\xea\xe0", "1251"), "река");
  EXPECT_EQ(to_utf8("\xf0\xe5\xea\xe0", "LDID/201"), "река");
}

TEST(CodePage, ChangesNoTextThatIsUtf8OrThatItDoesNotExplain) {
  EXPECT_EQ(to_utf8("Küste", "1252"), "Küste");
  EXPECT_EQ(to_utf8("coast", "no such page"), "coast");
  EXPECT_EQ(to_utf8("K\xfcste", "no such page"), "K\xfcste");
  EXPECT_EQ(to_utf8("K\xfcste", "UTF-8"), "K\xfcste");
}

}  // namespace
}  // namespace weft::files

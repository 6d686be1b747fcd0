// SPDX-License-Identifier: Apache-2.0
#include "files/bytes/file_contents.h"

#include <gtest/gtest.h>

#include "tests/files/support/temp_folder.h"

namespace weft::files {
namespace {

using namespace std::string_literals;

class TextFile : public ::testing::Test {
 protected:
  // What is read, or what is said of a file that is refused, less the folder.
  std::string read(const std::string& bytes, LineEnds ends = LineEnds::kLineFeeds) {
    const auto contents = read_text_file(folder_.write("d.txt", bytes), 1 << 20, ends);
    if (contents) return std::string(contents->text());
    EXPECT_EQ(contents.error().exit, ExitCode::kUnreadableInput);
    return contents.error().message.substr(folder_.path().string().size() + 1);
  }
  TempFolder folder_;
};

TEST_F(TextFile, HasNoByteOrderMark) {
  EXPECT_EQ(read("\xef\xbb\xbf"
                 "4 2"),
            "4 2");
  EXPECT_EQ(read("4 2\xef\xbb\xbf"), "4 2\xef\xbb\xbf");
  EXPECT_EQ(read("\xef\xbb\xbf"), "");
  EXPECT_EQ(read(""), "");
}

TEST_F(TextFile, IsUtf8IfItWasUtf16) {
  EXPECT_EQ(read("\xff\xfe"
                 "4\0\n\0"s),
            "4\n");
  EXPECT_EQ(read("\xfe\xff"
                 "\0"
                 "4\0\n"s),
            "4\n");
  EXPECT_EQ(read("\xff\xfe\xe4\0\xac\x20\x3d\xd8\x00\xde"s), "\u00e4\u20ac\U0001f600");
  EXPECT_EQ(read("\xff\xfe"), "");
}

TEST_F(TextFile, IsRefusedIfItsUtf16IsBroken) {
  EXPECT_EQ(read("\xff\xfe"
                 "4"),
            "d.txt: begins as UTF-16, but has an odd number of bytes");
  EXPECT_EQ(read("\xff\xfe"
                 "4\0\x00\xd8"s),
            "d.txt: begins as UTF-16, but byte 4 is half of a character");
  EXPECT_EQ(read("\xff\xfe\x00\xd8"
                 "4\0"s),
            "d.txt: begins as UTF-16, but byte 2 is half of a character");
  EXPECT_EQ(read("\xfe\xff\xde\x00\xd8\x3d"s),
            "d.txt: begins as UTF-16, but byte 2 is half of a character");
  EXPECT_EQ(read("\xff\xfe\0\0"
                 "4\0\0\0"s),
            "d.txt: is UTF-32: save it as UTF-8");
}

TEST_F(TextFile, HasLineFeedsAtTheEndsOfItsLines) {
  EXPECT_EQ(read("1\r2\r\r3\r"), "1\n2\n\n3\n");
  EXPECT_EQ(read("1\r\n2\r\n"), "1\r\n2\r\n");
  EXPECT_EQ(read("1\r\r\n2\r\r\n"), "1\r\r\n2\r\r\n");  // translated twice: no line between
  EXPECT_EQ(read("1\r2", LineEnds::kAsTheyAre), "1\r2");
}

TEST_F(TextFile, KeepsItsBytesIfItIsReadAsBytes) {
  const auto contents = read_file(folder_.write("d.txt",
                                                "\xef\xbb\xbf"
                                                "1\r2"),
                                  1 << 20);
  ASSERT_TRUE(contents);
  EXPECT_EQ(contents->text(),
            "\xef\xbb\xbf"
            "1\r2");
}

}  // namespace
}  // namespace weft::files

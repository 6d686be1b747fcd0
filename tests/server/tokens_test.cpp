// SPDX-License-Identifier: Apache-2.0
#include "server/tokens.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/client/support/temp_folder.h"
#include "tests/server/logged_server.h"

namespace weft::server {
namespace {

using testing::eventually;

std::string error_of(std::string_view text) {
  const auto table = TokenTable::parse(text);
  return table ? "" : table.error();
}

TEST(TokenTable, KnowsWhoseATokenIs) {
  const auto table = TokenTable::parse("# who may call\n\n ann\tsecret-1 \r\nbob secret-2").value();
  EXPECT_EQ(table.size(), 2u);
  EXPECT_EQ(table.name_of("secret-1"), "ann");
  EXPECT_EQ(table.name_of("secret-2"), "bob");
}

TEST(TokenTable, KnowsNoTokenThatItWasNotGiven) {
  const auto table = TokenTable::parse("ann secret-1\n").value();
  for (const char* token : {"", "secret-", "secret-10", "Secret-1", "ann", " secret-1"})
    EXPECT_EQ(table.name_of(token), std::nullopt) << token;
}

TEST(TokenTable, LetsANameHaveSeveralTokens) {
  const auto table = TokenTable::parse("ann old\nann new\n").value();
  EXPECT_EQ(table.name_of("old"), "ann");
  EXPECT_EQ(table.name_of("new"), "ann");
}

TEST(TokenTable, NamesTheLineAtFaultButNotItsToken) {
  for (const char* text : {"ann s1\nbob\n", "ann s1\nbob s2 s3\n", "ann s1\nbob s1\n",
                           "ann s1\nb\x01 s2\n", "ann s1\nbob s\xc3\xa4\n"}) {
    EXPECT_EQ(error_of(text).rfind("line 2: ", 0), 0u) << error_of(text);
    EXPECT_EQ(error_of(text).find("s1"), std::string::npos) << error_of(text);
    EXPECT_EQ(error_of(text).find("s2"), std::string::npos) << error_of(text);
  }
}

TEST(TokenTable, RefusesToBeEmpty) {
  EXPECT_NE(error_of("# nobody\n"), "");
}

class TokenFiles : public ::testing::Test {
 protected:
  void write(std::string_view text) { std::filesystem::rename(folder_.write("new", text), path_); }
  std::unique_ptr<TokenFile> open() {
    return TokenFile::open(path_, log_.logger(), std::chrono::milliseconds(5)).value();
  }

  client::TempFolder folder_;
  const std::filesystem::path path_ = folder_ / "tokens";
  testing::Log log_;
};

TEST_F(TokenFiles, AreReadAgainWhenTheyChange) {
  write("ann one\n");
  const auto file = open();
  EXPECT_EQ(file->table()->name_of("one"), "ann");
  write("ann two\n");
  EXPECT_TRUE(eventually([&] { return file->table()->name_of("two") == "ann"; }));
  EXPECT_EQ(file->table()->name_of("one"), std::nullopt);
}

TEST_F(TokenFiles, ThatTurnBadLeaveTheTableAsItWas) {
  write("ann one\n");
  const auto file = open();
  for (const char* bad : {"ann\n", ""}) {
    write(bad);
    EXPECT_TRUE(eventually([&] { return log_.contains("event=tokens_kept"); }));
    EXPECT_EQ(file->table()->name_of("one"), "ann");
  }
  std::filesystem::remove(path_);
  EXPECT_TRUE(eventually([&] { return log_.contains("No such file"); })) << log_.text();
  EXPECT_EQ(file->table()->name_of("one"), "ann");
  write("ann two\n");
  EXPECT_TRUE(eventually([&] { return file->table()->name_of("two") == "ann"; }));
}

TEST_F(TokenFiles, AreNamedWhereTheyCannotBeOpened) {
  const auto open_error = [&] {
    const auto file = TokenFile::open(path_, log_.logger());
    return file ? "" : file.error();
  };
  EXPECT_NE(open_error().find(path_.string() + ": No such file"), std::string::npos)
      << open_error();
  std::filesystem::create_directory(path_);
  EXPECT_NE(open_error().find("directory"), std::string::npos) << open_error();
  std::filesystem::remove(path_);
  write(std::string(std::size_t{2} << 20, '#'));
  EXPECT_NE(open_error().find("more than 1048576 bytes"), std::string::npos) << open_error();
}

}  // namespace
}  // namespace weft::server

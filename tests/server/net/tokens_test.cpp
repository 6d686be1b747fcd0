// SPDX-License-Identifier: Apache-2.0
#include "server/net/tokens.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/files/support/temp_folder.h"
#include "tests/server/logged_server.h"

namespace weft::server {
namespace {

using testing::eventually;

std::string error_of(std::string_view text) {
  const auto table = TokenTable::parse(text);
  return table ? "" : table.error();
}

TEST(TokenTable, KnowsWhoseATokenIs) {
  const auto table =
      TokenTable::parse("# who may call\n\n ann\tthe-secret-nr-001 \r\nbob the-secret-nr-002")
          .value();
  EXPECT_EQ(table.size(), 2u);
  EXPECT_EQ(table.name_of("the-secret-nr-001"), "ann");
  EXPECT_EQ(table.name_of("the-secret-nr-002"), "bob");
}

TEST(TokenTable, KnowsNoTokenThatItWasNotGiven) {
  const auto table = TokenTable::parse("ann the-secret-nr-001\n").value();
  for (const char* token : {"", "the-secret-nr-00", "the-secret-nr-0010", "The-secret-nr-001",
                            "ann", " the-secret-nr-001"})
    EXPECT_EQ(table.name_of(token), std::nullopt) << token;
}

TEST(TokenTable, LetsANameHaveSeveralTokens) {
  const auto table =
      TokenTable::parse("ann the-old-secret-nr-1\nann the-new-secret-nr-2\n").value();
  EXPECT_EQ(table.name_of("the-old-secret-nr-1"), "ann");
  EXPECT_EQ(table.name_of("the-new-secret-nr-2"), "ann");
}

TEST(TokenTable, NamesTheLineAtFaultButNotItsToken) {
  const std::string ann = "ann s1-0123456789abcdef\n";
  for (const std::string line :
       {"bob\n", "bob s2-0123456789abcdef s3-0123456789abcdef\n", "bob s1-0123456789abcdef\n",
        "b\x01 s2-0123456789abcdef\n", "bob s2-0123456789abcdef\xc3\xa4\n", "bob s2-0123456789ab\n",
        "bob s2-456789abcdef\n"}) {
    const std::string text = ann + line;
    EXPECT_EQ(error_of(text).rfind("line 2: ", 0), 0u) << error_of(text);
    EXPECT_EQ(error_of(text).find("s1"), std::string::npos) << error_of(text);
    EXPECT_EQ(error_of(text).find("s2"), std::string::npos) << error_of(text);
  }
}

TEST(TokenTable, TakesATokenOfTheLeastLengthAndNoShorterOne) {
  EXPECT_EQ(error_of("ann 0123456789abcdef\n"), "");
  EXPECT_EQ(error_of("ann 0123456789abcde\n"),
            "line 1: the token has 15 characters; the least is 16");
}

TEST(TokenTable, RefusesToBeEmpty) {
  EXPECT_NE(error_of("# nobody\n"), "");
}

using testing::Log;

class TokenFiles : public ::testing::Test {
 protected:
  void write(std::string_view text) { std::filesystem::rename(folder_.write("new", text), path_); }
  std::unique_ptr<TokenFile> open() {
    return TokenFile::open(path_, log_.logger(), std::chrono::milliseconds(5)).value();
  }

  files::TempFolder folder_;
  const std::filesystem::path path_ = folder_ / "tokens";
  testing::Log log_;
};

TEST_F(TokenFiles, AreReadAgainWhenTheyChange) {
  write("ann the-token-nr-one\n");
  const auto file = open();
  EXPECT_EQ(file->table()->name_of("the-token-nr-one"), "ann");
  write("ann the-token-nr-two\n");
  EXPECT_TRUE(eventually([&] { return file->table()->name_of("the-token-nr-two") == "ann"; }));
  EXPECT_EQ(file->table()->name_of("the-token-nr-one"), std::nullopt);
}

TEST_F(TokenFiles, ThatTurnBadLeaveTheTableAsItWas) {
  write("ann the-token-nr-one\n");
  const auto file = open();
  for (const char* bad : {"ann\n", ""}) {
    write(bad);
    EXPECT_TRUE(eventually([&] { return log_.contains("event=tokens_kept"); }));
    EXPECT_EQ(file->table()->name_of("the-token-nr-one"), "ann");
  }
  std::filesystem::remove(path_);
  EXPECT_TRUE(eventually([&] { return log_.contains("No such file"); })) << log_.text();
  EXPECT_EQ(file->table()->name_of("the-token-nr-one"), "ann");
  write("ann the-token-nr-two\n");
  EXPECT_TRUE(eventually([&] { return file->table()->name_of("the-token-nr-two") == "ann"; }));
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

TEST_F(TokenFiles, AreReadAtOnceWhenThatIsAskedFor) {
  write("ann the-token-nr-one\n");
  const auto file = TokenFile::open(path_, log_.logger(), std::chrono::hours(1)).value();
  std::atomic<int> changes{0};
  file->on_change([&] { ++changes; });
  file->reload();
  write("ann the-token-nr-two\n");
  file->reload();
  EXPECT_TRUE(eventually([&] { return file->table()->name_of("the-token-nr-two") == "ann"; }));
  EXPECT_TRUE(eventually([&] { return changes == 1; }));
  file->on_change({});
  write("ann the-token-nr-one\n");
  file->reload();
  EXPECT_TRUE(eventually([&] { return file->table()->name_of("the-token-nr-one") == "ann"; }));
  EXPECT_EQ(changes, 1);
}

TEST_F(TokenFiles, ThatOthersMayReadOrWriteAreWarnedOfOnce) {
  write("ann the-token-nr-one\n");
  const auto mode = [&](unsigned bits) {
    std::filesystem::permissions(path_, static_cast<std::filesystem::perms>(bits));
  };
  mode(0640);
  const auto file = open();
  EXPECT_FALSE(log_.contains("event=tokens_exposed"));
  mode(0666);
  EXPECT_TRUE(eventually([&] { return log_.contains("event=tokens_exposed"); }));
  EXPECT_TRUE(log_.contains("mode=0666"));
  write("ann the-token-nr-two\n");
  mode(0666);
  EXPECT_TRUE(eventually([&] { return file->table()->name_of("the-token-nr-two") == "ann"; }));
  for (const unsigned bits : {0644U, 0620U, 0604U}) {
    Log log;
    mode(bits);
    const auto other = TokenFile::open(path_, log.logger());
    EXPECT_TRUE(log.contains("event=tokens_exposed")) << std::oct << bits;
  }
}

}  // namespace
}  // namespace weft::server

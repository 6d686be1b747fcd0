// SPDX-License-Identifier: Apache-2.0
#include "files/base/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <utility>

#include "tests/files/support/temp_folder.h"

namespace weft::files {
namespace {

using FileNames = std::vector<std::string>;

std::vector<OutputFile> open_all(const std::vector<std::filesystem::path>& targets) {
  std::vector<OutputFile> files;
  for (const auto& target : targets)
    files.push_back(std::move(OutputFile::create(target, {}).value()));
  return files;
}

TEST(AtomicFile, AppearsWhenCommittedAndNotBefore) {
  TempFolder folder;
  auto files = open_all({folder / "a.txt"});
  files[0].put("hello ");
  files[0].number(0.1);
  files[0].put(' ');
  files[0].number(std::int64_t{-42});
  EXPECT_EQ(folder.names(), FileNames{});
  ASSERT_TRUE(commit(files));
  EXPECT_EQ(folder.names(), FileNames{"a.txt"});
  EXPECT_EQ(contents_of(folder / "a.txt"), "hello 0.1 -42");
}

TEST(AtomicFile, LeavesNothingWhenDropped) {
  TempFolder folder;
  { open_all({folder / "a.txt"})[0].put("half"); }
  EXPECT_EQ(folder.names(), FileNames{});
}

TEST(AtomicFile, ReplacesAnOlderFileInOneStep) {
  TempFolder folder;
  folder.write("a.txt", "old");
  auto files = open_all({folder / "a.txt"});
  files[0].put("new");
  EXPECT_EQ(contents_of(folder / "a.txt"), "old");
  ASSERT_TRUE(commit(files));
  EXPECT_EQ(contents_of(folder / "a.txt"), "new");
}

TEST(AtomicFile, FollowsALink) {
  TempFolder folder;
  folder.write("a.txt", "old");
  std::filesystem::create_symlink("a.txt", folder / "link.txt");
  auto files = open_all({folder / "link.txt"});
  files[0].put("new");
  ASSERT_TRUE(commit(files));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
  EXPECT_EQ(contents_of(folder / "a.txt"), "new");
}

TEST(AtomicFile, CommitsAllOrNone) {
  TempFolder folder;
  auto files = open_all({folder / "a.txt", folder / "b.txt"});
  files[0].put("a");
  std::filesystem::create_directory(folder / "b.txt");
  const auto done = commit(files);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().exit, ExitCode::kUnwritableOutput);
  files.clear();
  EXPECT_EQ(folder.names(), FileNames{"b.txt"});
}

TEST(AtomicFile, WritesMoreThanItsBuffer) {
  TempFolder folder;
  std::string text;
  for (int i = 0; i < 500'000; ++i) text += std::to_string(i);
  auto files = open_all({folder / "a.txt"});
  files[0].put("start");
  files[0].put(text);
  for (const char c : std::string("end")) files[0].put(c);
  ASSERT_TRUE(commit(files));
  EXPECT_EQ(contents_of(folder / "a.txt"), "start" + text + "end");
}

TEST(AtomicFile, NamesAMissingFolder) {
  TempFolder folder;
  const auto file = OutputFile::create(folder / "no" / "a.txt", {});
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().exit, ExitCode::kUnwritableOutput);
  EXPECT_NE(file.error().message.find("No such file or directory"), std::string::npos);
}

TEST(AtomicFile, MakesMissingFoldersWhenAllIsComplete) {
  TempFolder folder;
  std::vector<OutputFile> files;
  for (const auto& name : {folder / "new" / "deep" / "a.txt", folder / "new" / "b.txt"}) {
    auto file = OutputFile::create(name, {}, MissingFolders::kMake);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->folder(), folder.path());
    file->put("text");
    files.push_back(std::move(*file));
  }
  EXPECT_EQ(folder.names(), FileNames{});
  ASSERT_TRUE(commit(files));
  EXPECT_EQ(folder.names(), FileNames{"new"});
  EXPECT_EQ(contents_of(folder / "new" / "deep" / "a.txt"), "text");
  EXPECT_EQ(contents_of(folder / "new" / "b.txt"), "text");
}

TEST(AtomicFile, LeavesNoNewFolderWithoutItsFiles) {
  TempFolder folder;
  std::stop_source stop;
  std::vector<OutputFile> files;
  files.push_back(*OutputFile::create(folder / "a.txt", stop.get_token()));
  files.push_back(
      *OutputFile::create(folder / "new" / "b.txt", stop.get_token(), MissingFolders::kMake));
  std::filesystem::create_directory(folder / "a.txt");
  EXPECT_FALSE(commit(files));
  EXPECT_EQ(folder.names(), FileNames{"a.txt"});
  std::filesystem::remove(folder / "a.txt");
  stop.request_stop();
  EXPECT_FALSE(commit(files));
  files.clear();
  EXPECT_EQ(folder.names(), FileNames{});
}

TEST(AtomicFile, RefusesATargetThatIsNoRegularFile) {
  EXPECT_FALSE(OutputFile::create("/dev/null", {}));
}

TEST(AtomicFile, StopsWhenAskedTo) {
  TempFolder folder;
  std::stop_source stop;
  auto file = OutputFile::create(folder / "a.txt", stop.get_token());
  file->put("text");
  stop.request_stop();
  const auto done = file->finish();
  ASSERT_FALSE(done);
  EXPECT_TRUE(done.error().message.ends_with("interrupted"));
}

// In a process of its own: the limit on file sizes plays the full disk.
TEST(AtomicFile, ReportsAFullDiskAndLeavesNothing) {
  TempFolder folder;
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{100'000, 100'000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    auto files = open_all({folder / "a.txt"});
    files[0].put(std::string(10'000'000, 'x'));
    const auto done = commit(files);
    ::_exit(!done && done.error().message.find("File too large") != std::string::npos ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(folder.names(), FileNames{});
}

TEST(AtomicFile, LeavesNothingWhenKilled) {
  TempFolder folder;
  const pid_t child = ::fork();
  if (child == 0) {
    auto files = open_all({folder / "a.txt"});
    files[0].put(std::string(3'000'000, 'x'));
    ::raise(SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(folder.names(), FileNames{});
}

}  // namespace
}  // namespace weft::files

// SPDX-License-Identifier: Apache-2.0
// Runs build/.../weft as a user does, with a fake weftd (fake_weftd.cpp) for a private server, and
// tells what came of it.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "client/base/files.h"
#include "tests/files/support/temp_folder.h"
#include "tests/support/paths.h"

namespace weft::client {

using Words = std::vector<std::string>;

class WeftProcess : public ::testing::Test {
 protected:
  WeftProcess() {
    std::filesystem::create_directory(folder_ / "tmp");
    std::filesystem::create_directory(folder_ / "out");
    folder_.write("in.poly",
                  "4 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n"
                  "4 1\n1 1 2 1\n2 2 3 2\n3 3 4 3\n4 4 1 4\n0\n");
  }

  Words mesh_to(const std::string& name) const {
    return {"mesh", (folder_ / "in.poly").string(), "-o", (folder_ / "out" / name).string()};
  }

  // `terminal` is stdin and stdout of the process, where there is one; else stdin is `input_`,
  // where there is one.
  pid_t start(const Words& words, const Words& variables = {}, int terminal = -1) {
    Words arguments = {weft::testing::kWeft};
    arguments.insert(arguments.end(), words.begin(), words.end());
    Words environment = {std::string("WEFT_WEFTD=") + weft::testing::kFakeWeftd,
                         "TMPDIR=" + (folder_ / "tmp").string(),
                         "FAKE_WEFTD_PID=" + (folder_ / "pid").string()};
    if (const char* const leaks = std::getenv("LSAN_OPTIONS"))
      environment.push_back(std::string("LSAN_OPTIONS=") + leaks);
    environment.insert(environment.end(), variables.begin(), variables.end());
    const auto pointers = [](Words& list) {
      std::vector<char*> out;
      for (std::string& word : list) out.push_back(word.data());
      out.push_back(nullptr);
      return out;
    };
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    if (terminal >= 0) {
      posix_spawn_file_actions_adddup2(&actions, terminal, 0);
      posix_spawn_file_actions_adddup2(&actions, terminal, 1);
    } else {
      if (input_ >= 0) posix_spawn_file_actions_adddup2(&actions, input_, 0);
      posix_spawn_file_actions_addopen(&actions, 1, (folder_ / "stdout").c_str(),
                                       O_WRONLY | O_CREAT | O_TRUNC, 0600);
    }
    posix_spawn_file_actions_addopen(&actions, 2, (folder_ / "stderr").c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0600);
    pid_t pid = 0;
    EXPECT_EQ(::posix_spawn(&pid, weft::testing::kWeft, &actions, nullptr,
                            pointers(arguments).data(), pointers(environment).data()),
              0);
    posix_spawn_file_actions_destroy(&actions);
    return pid;
  }
  // The exit code, or 128 + the signal.
  static int end_of(pid_t pid) {
    int status = 0;
    ::waitpid(pid, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  int run(const Words& words, const Words& variables = {}) {
    return end_of(start(words, variables));
  }
  std::string out() const { return contents_of(folder_ / "stdout"); }
  std::string err() const { return contents_of(folder_ / "stderr"); }
  std::string out_file(const std::string& name) const { return folder_ / "out" / name; }
  Words left_in(const std::string& name) const {
    Words names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / name))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

  TempFolder folder_;
  int input_ = -1;  // a descriptor
};

}  // namespace weft::client

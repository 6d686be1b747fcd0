// SPDX-License-Identifier: Apache-2.0
// A real weft that writes meshes larger than the memory it may take, and is ended while it does.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "tests/e2e/programs.h"

namespace weft::e2e {
namespace {

// About eight million triangles, which the server makes once.
const std::vector<std::string> kServer = {"--threads", "2", "--cache-bytes", "1GiB"};

class LargeFiles : public ::testing::Test {
 protected:
  LargeFiles() {
    std::filesystem::create_directory(folder_ / "out");
    folder_.write("in.poly",
                  "4 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n"
                  "4 1\n1 1 2 1\n2 2 3 2\n3 3 4 3\n4 4 1 4\n0\n");
  }

  std::vector<std::string> mesh(const std::vector<std::string>& output) const {
    std::vector<std::string> words = {
        "mesh", folder_ / "in.poly", "-q", "--server", server_.address(), "--size", "2.5e-6"};
    words.insert(words.end(), output.begin(), output.end());
    return words;
  }
  std::string file(const std::string& name) const { return folder_ / "out" / name; }
  // Files in the folder of the output that the process has open.
  static std::size_t open_files(pid_t pid, const std::string& folder) {
    std::size_t count = 0;
    std::error_code gone;
    for (const auto& entry :
         std::filesystem::directory_iterator("/proc/" + std::to_string(pid) + "/fd", gone))
      count += std::filesystem::read_symlink(entry, gone).string().starts_with(folder);
    return count;
  }

  Folder folder_;
  Server server_{kServer};
};

TEST_F(LargeFiles, TakeNoMoreMemoryThanSmallOnes) {
#ifdef WEFT_SANITIZED
  GTEST_SKIP() << "sanitizers take memory of their own";
#endif
  // In memory or mapped and kept, the arrays alone are 160 MB, and 320 MB for edges, besides the 55
  // to 117 MiB that a weft takes, or 134 MiB for a picture.
  constexpr std::uint64_t kMax = 180 << 20;
  constexpr std::uint64_t kOfPicture = 16 * 1800 * 1800;  // sums of values, colours
  const std::vector<std::vector<std::string>> outputs = {
      {"-o", file("m.vtu")},    {"-o", file("m.npz")},
      {"-o", file("m.msh")},    {"-o", file("m.node")},
      {"-o", file("m.edge")},   {"-o", file("m.14")},
      {"-o", file("m.stl")},    {"-o", file("o.vtu"), "--order", "2"},
      {"--draw", file("m.png")}};
  for (const auto& output : outputs) {
    const Outcome outcome = run_weft(mesh(output));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_LT(outcome.peak_bytes, kMax + (output[0] == "--draw" ? kOfPicture : 0)) << output[1];
    std::filesystem::remove(output[1]);
  }
}

TEST_F(LargeFiles, LeaveNothingBehindIfWritingEndsInTheMiddle) {
  // One file is the output, six hold the mesh; more are of the writer.
  constexpr std::size_t kWriting = 8;
  for (const int signal : {SIGKILL, SIGTERM}) {
    const pid_t pid = start_weft(mesh({"-o", file("m.vtu"), "--order", "2"}));
    while (open_files(pid, folder_ / "out") < kWriting && ::waitpid(pid, nullptr, WNOHANG) == 0)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_EQ(::kill(pid, signal), 0) << "it ended before it could be ended";
    int status = 0;
    ASSERT_EQ(::waitpid(pid, &status, 0), pid);
    EXPECT_FALSE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    EXPECT_TRUE(std::filesystem::is_empty(folder_ / "out")) << signal;
  }
}

}  // namespace
}  // namespace weft::e2e

// SPDX-License-Identifier: Apache-2.0
#include "client/call/private_server.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <thread>

#include "tests/files/support/temp_folder.h"
#include "tests/support/paths.h"

namespace weft::client {
namespace {

class Private : public ::testing::Test {
 protected:
  Private() { ::setenv("TMPDIR", folder_.path().c_str(), 1); }
  ~Private() override {
    ::unsetenv("FAKE_WEFTD");
    ::unsetenv("TMPDIR");
  }
  static PrivateServerOptions fake(const char* behaviour) {
    ::setenv("FAKE_WEFTD", behaviour, 1);
    return {.weftd = weft::testing::kFakeWeftd};
  }
  static bool is_alive(pid_t pid) { return ::kill(pid, 0) == 0; }

  TempFolder folder_;
};

TEST_F(Private, ListensInAFolderOfItsOwnAndLeavesNothing) {
  pid_t pid = 0;
  {
    const auto server = PrivateServer::start(fake(""), {});
    ASSERT_TRUE(server) << server.error().message;
    pid = (*server)->pid();
    EXPECT_TRUE(is_alive(pid));
    const std::filesystem::path socket = (*server)->address().substr(5);
    EXPECT_TRUE(std::filesystem::is_socket(socket));
    EXPECT_EQ(std::filesystem::status(socket.parent_path()).permissions(),
              std::filesystem::perms::owner_all);
    EXPECT_EQ(socket.parent_path().parent_path(), folder_.path());
  }
  EXPECT_FALSE(is_alive(pid));
  EXPECT_TRUE(folder_.names().empty());
}

TEST_F(Private, InheritsNothingThatConfiguresOtherServers) {
  const auto file = folder_ / "environment";
  ::setenv("FAKE_WEFTD_ENVIRONMENT", file.c_str(), 1);
  ::setenv("WEFT_DATA", "/var/lib/weft", 1);
  ::setenv("WEFT_OF_TOMORROW", "1", 1);
  ::setenv("WEFT_TOKEN", "secret", 1);
  const auto server = PrivateServer::start(fake(""), {});
  for (const char* name : {"FAKE_WEFTD_ENVIRONMENT", "WEFT_DATA", "WEFT_OF_TOMORROW", "WEFT_TOKEN"})
    ::unsetenv(name);
  ASSERT_TRUE(server) << server.error().message;
  const std::string environment = contents_of(file);
  EXPECT_NE(environment.find("\nTMPDIR="), std::string::npos) << environment;
  EXPECT_EQ(environment.find("\nWEFT_"), std::string::npos) << environment;
}

TEST_F(Private, KillsAServerThatWillNotEnd) {
  pid_t pid = 0;
  {
    const auto server = PrivateServer::start(fake("stubborn"), {});
    ASSERT_TRUE(server) << server.error().message;
    pid = (*server)->pid();
  }
  EXPECT_FALSE(is_alive(pid));
}

TEST_F(Private, ShowsTheLastLinesOfOneThatDiesAtStart) {
  const auto server = PrivateServer::start(fake("die"), {});
  ASSERT_FALSE(server);
  EXPECT_EQ(server.error().exit, ExitCode::kServerNotStarted);
  EXPECT_TRUE(server.error().message.ends_with(
      " ended at start; it said:\n  event=starting\n  event=cannot_listen message=\"no luck "
      "today\""))
      << server.error().message;
  EXPECT_TRUE(folder_.names().empty());
}

TEST_F(Private, GivesUpOnOneThatIsNeverReady) {
  auto options = fake("never-ready");
  options.start_timeout = std::chrono::milliseconds(100);
  const auto server = PrivateServer::start(options, {});
  ASSERT_FALSE(server);
  EXPECT_NE(server.error().message.find("is not ready after 100 ms"), std::string::npos);
}

TEST_F(Private, StopsWaitingWhenAskedTo) {
  std::stop_source stop;
  stop.request_stop();
  const auto server = PrivateServer::start(fake("never-ready"), stop.get_token());
  ASSERT_FALSE(server);
  EXPECT_NE(server.error().message.find("interrupted"), std::string::npos);
  EXPECT_TRUE(folder_.names().empty());
}

TEST_F(Private, SaysThatTheBinaryIsMissing) {
  const auto server = PrivateServer::start({.weftd = folder_ / "nowhere"}, {});
  ASSERT_FALSE(server);
  EXPECT_EQ(server.error().exit, ExitCode::kServerNotStarted);
  EXPECT_NE(server.error().message.find("No such file or directory"), std::string::npos);
}

TEST_F(Private, DiesWithAClientThatIsKilled) {
  ::setenv("FAKE_WEFTD_PID", (folder_ / "pid").c_str(), 1);
  const pid_t client = ::fork();
  if (client == 0) {
    const auto server = PrivateServer::start(fake(""), {});
    ::raise(SIGKILL);
  }
  ::unsetenv("FAKE_WEFTD_PID");
  int status = 0;
  ::waitpid(client, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  const pid_t server = std::stoi(contents_of(folder_ / "pid"));
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (is_alive(server) && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
  EXPECT_FALSE(is_alive(server));
}

}  // namespace
}  // namespace weft::client

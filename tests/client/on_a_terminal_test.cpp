// SPDX-License-Identifier: Apache-2.0
// What the commands on jobs draw on a terminal, and in what state they leave it.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <csignal>

#include "files/base/atomic_file.h"
#include "tests/client/support/job_commands.h"

namespace weft::client {
namespace {

// The other end of a terminal, 60 columns by 20 lines.
class OnATerminal : public JobCommands {
 protected:
  OnATerminal() : master_(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    ::grantpt(master_.get());
    ::unlockpt(master_.get());
    char name[64];
    ::ptsname_r(master_.get(), name, sizeof name);
    slave_ = FileDescriptor(::open(name, O_RDWR | O_NOCTTY | O_CLOEXEC));
    const winsize size{20, 60, 0, 0};
    ::ioctl(slave_.get(), TIOCSWINSZ, &size);
  }
  pid_t start_here(const Words& words) {
    return start(words, {"WEFT_SERVER=" + fake_.address()}, slave_.get());
  }
  // Reads on until the screen has got this.
  bool shows(const std::string& text) {
    while (shown_.find(text) == std::string::npos) {
      constexpr int kPatience = 60'000;  // milliseconds
      pollfd readable{master_.get(), POLLIN, 0};
      char buffer[4096];
      if (::poll(&readable, 1, kPatience) <= 0) return false;
      const ssize_t size = ::read(master_.get(), buffer, sizeof buffer);
      if (size <= 0) return false;
      shown_.append(buffer, static_cast<std::size_t>(size));
    }
    return true;
  }
  // Whether keys are echoed and come by the line, as they were before.
  bool is_as_before() {
    termios keys{};
    ::tcgetattr(slave_.get(), &keys);
    return (keys.c_lflag & ICANON) != 0 && (keys.c_lflag & ECHO) != 0;
  }

  FileDescriptor master_;
  FileDescriptor slave_;
  std::string shown_;
};

constexpr char kEnter[] = "\033[?1049h\033[?25l";
constexpr char kLeave[] = "\033[?25h\033[?1049l";

TEST_F(OnATerminal, TopDrawsInPlaceUntilItIsToldToEnd) {
  ASSERT_TRUE(is_as_before());
  jobs_.put(sample_job("first", v1::JOB_STATE_RUNNING));
  const pid_t pid = start_here({"top", "--interval", "0.1"});
  ASSERT_TRUE(shows("first  refining ["));
  EXPECT_TRUE(shown_.starts_with(kEnter));
  EXPECT_FALSE(is_as_before());
  jobs_.put(sample_job("second", v1::JOB_STATE_RUNNING));
  ASSERT_TRUE(shows("second  refining ["));
  ASSERT_EQ(::write(master_.get(), "q", 1), 1);
  EXPECT_EQ(end_of(pid), 0) << err();
  EXPECT_TRUE(shows(kLeave));
  EXPECT_TRUE(is_as_before());
  EXPECT_EQ(err(), "");
}

TEST_F(OnATerminal, TopGivesTheScreenBackWhenInterrupted) {
  const pid_t pid = start_here({"top", "--interval", "600"});
  ASSERT_TRUE(shows("queued 0  running 0"));
  ::kill(pid, SIGINT);
  EXPECT_EQ(end_of(pid), 128 + SIGINT);
  EXPECT_TRUE(shows(kLeave));
  EXPECT_TRUE(is_as_before());
  EXPECT_EQ(err(), "");
}

TEST_F(OnATerminal, TopLivesThroughACallThatAServerCancelsAtItsEnd) {
  const pid_t pid = start_here({"top", "--interval", "0.1"});
  ASSERT_TRUE(shows("queued 0  running 0"));
  Fault cancelled;
  cancelled.status = grpc::Status(grpc::StatusCode::CANCELLED, "the server ends");
  jobs_.fail("ListJobs", {cancelled});
  ASSERT_TRUE(shows("answers CANCELLED"));
  jobs_.put(sample_job("later", v1::JOB_STATE_RUNNING));
  EXPECT_TRUE(shows("later  refining ["));
  ::kill(pid, SIGTERM);
  EXPECT_EQ(end_of(pid), 128 + SIGTERM);
}

TEST_F(OnATerminal, TopLivesThroughAServerThatIsAway) {
  const pid_t pid = start_here({"top", "--interval", "0.1"});
  ASSERT_TRUE(shows("queued 0  running 0"));
  fake_.stop();
  ASSERT_TRUE(shows("answers UNAVAILABLE"));
  shown_.clear();
  jobs_.put(sample_job("later", v1::JOB_STATE_RUNNING));
  fake_.start();
  EXPECT_TRUE(shows("later  refining ["));
  ::kill(pid, SIGTERM);
  EXPECT_EQ(end_of(pid), 128 + SIGTERM);
}

TEST_F(OnATerminal, WatchShowsABarAndTakesItAway) {
  plan(v1::JOB_STATE_SUCCEEDED);
  ASSERT_EQ(ask(submit()), 0);
  const pid_t pid = start_here({"watch", "job-1"});
  EXPECT_TRUE(
      shows("\r\033[Krefining [#######......................."
            "] 1,000 triangles so far"));
  EXPECT_TRUE(shows("\r\033[K32 triangles, 25 vertices, angles 45.00 to 90.00 degrees"));
  EXPECT_EQ(end_of(pid), 0);
}

}  // namespace
}  // namespace weft::client

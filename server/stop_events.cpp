// SPDX-License-Identifier: Apache-2.0
#include "server/stop_events.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <system_error>

namespace weft::server {
namespace {

int checked(int result, const char* what) {
  if (result < 0) throw std::system_error(errno, std::generic_category(), what);
  return result;
}

int open_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGHUP);
  checked(-pthread_sigmask(SIG_BLOCK, &set, nullptr), "pthread_sigmask");
  return checked(::signalfd(-1, &set, SFD_CLOEXEC), "signalfd");
}

// True at the end of standard input; what comes before is dropped.
bool input_ended() {
  char dropped[4096];
  const ssize_t n = ::read(STDIN_FILENO, dropped, sizeof(dropped));
  return n == 0 || (n < 0 && errno != EINTR && errno != EAGAIN);
}

}  // namespace

StopEvents::StopEvents(bool watch_input)
    : signals_(open_signals()),
      notes_(checked(::eventfd(0, EFD_CLOEXEC), "eventfd")),
      watch_input_(watch_input) {}

StopEvents::~StopEvents() {
  ::close(signals_);
  ::close(notes_);
}

StopEvents::Event StopEvents::wait() {
  while (true) {
    pollfd fds[] = {{signals_, POLLIN, 0},
                    {notes_, POLLIN, 0},
                    {watch_input_ ? STDIN_FILENO : -1, POLLIN, 0}};  // poll skips negative ones
    if (::poll(fds, 3, -1) < 0) {
      if (errno == EINTR) continue;
      throw std::system_error(errno, std::generic_category(), "poll");
    }
    if (fds[0].revents != 0) {
      signalfd_siginfo info{};
      if (::read(signals_, &info, sizeof(info)) == sizeof(info))
        return {Kind::kSignal, static_cast<int>(info.ssi_signo)};
    }
    if (fds[1].revents != 0) {
      std::uint64_t count = 0;
      if (::read(notes_, &count, sizeof(count)) == sizeof(count)) return {Kind::kNotified, 0};
    }
    if (fds[2].revents != 0 && input_ended()) {
      watch_input_ = false;
      return {Kind::kInputEnded, 0};
    }
  }
}

void StopEvents::notify() {
  const std::uint64_t one = 1;
  while (::write(notes_, &one, sizeof(one)) < 0 && errno == EINTR) {
  }
}

}  // namespace weft::server

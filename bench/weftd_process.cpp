// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/weftd_process.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <thread>
#include <vector>

namespace weft::bench {

std::unique_ptr<WeftdProcess> WeftdProcess::start(const std::string& weftd, int threads) {
  std::unique_ptr<WeftdProcess> server(new WeftdProcess);
  if (!server->spawn(weftd, threads) || !server->wait_until_ready()) return nullptr;
  return server;
}

bool WeftdProcess::spawn(const std::string& weftd, int threads) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) {
    std::fprintf(stderr, "pipe: %s\n", std::strerror(errno));
    return false;
  }
  unix_address_ = "unix:" + (folder_ / "socket").string();
  its_input_ = ends[1];

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  std::string arguments[] = {weftd,
                             "--listen",
                             unix_address_,
                             "--listen",
                             "127.0.0.1:0",
                             "--port-file",
                             folder_ / "ready",
                             "--threads",
                             std::to_string(threads),
                             "--data",
                             folder_ / "data",
                             "--log-level",
                             "warning",
                             "--exit-with-stdin"};
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const int problem = ::posix_spawn(&pid_, weftd.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[0]);
  if (problem == 0) return true;
  pid_ = 0;
  std::fprintf(stderr, "%s: %s\n", weftd.c_str(), std::strerror(problem));
  return false;
}

// The server renames the port file into place when it listens.
bool WeftdProcess::wait_until_ready() {
  while (!std::filesystem::exists(folder_ / "ready")) {
    if (::waitpid(pid_, nullptr, WNOHANG) == pid_) {
      pid_ = 0;
      std::fprintf(stderr, "weftd ended at start\n");
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  std::ifstream addresses(folder_ / "ready");
  for (std::string line; std::getline(addresses, line);) {
    if (!line.starts_with("unix:")) tcp_address_ = line;
  }
  return true;
}

WeftdProcess::~WeftdProcess() {
  if (its_input_ >= 0) ::close(its_input_);
  if (pid_ > 0) ::waitpid(pid_, nullptr, 0);
}

std::uint64_t WeftdProcess::peak_bytes() const {
  std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
  for (std::string line; std::getline(status, line);) {
    unsigned long long kibibytes = 0;
    if (std::sscanf(line.c_str(), "VmHWM: %llu kB", &kibibytes) == 1) return kibibytes * 1024;
  }
  return 0;
}

}  // namespace weft::bench

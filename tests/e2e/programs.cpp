// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/programs.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "tests/support/http.h"
#include "tests/support/paths.h"

extern char** environ;

namespace weft::e2e {
namespace {

std::string contents(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

// Starts a program with its output in files; stdin is empty.
pid_t start(const std::string& program, const std::vector<std::string>& arguments,
            const std::string& out, const std::string& err) {
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  constexpr int kWrite = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), kWrite, 0600);
  posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), kWrite, 0600);
  pid_t pid = -1;
  const int error = posix_spawn(&pid, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw std::runtime_error("cannot start " + program);
  return pid;
}

// The exit code, or 128 + the signal.
int wait_for(pid_t pid, rusage* usage = nullptr) {
  int status = 0;
  wait4(pid, &status, 0, usage);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

pid_t start_weft(const std::vector<std::string>& arguments) {
  return start(testing::kWeft, arguments, "/dev/null", "/dev/null");
}

Outcome run_weft(const std::vector<std::string>& arguments) {
  return run_program(testing::kWeft, arguments);
}

Outcome run_program(const std::string& program, const std::vector<std::string>& arguments) {
  const Folder folder;
  Outcome outcome;
  rusage usage{};
  outcome.exit_code = wait_for(start(program, arguments, folder / "out", folder / "err"), &usage);
  outcome.peak_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
  outcome.out = contents(folder / "out");
  outcome.err = contents(folder / "err");
  return outcome;
}

Server::Server(const std::vector<std::string>& arguments, unsigned descriptors)
    : arguments_(arguments),
      descriptors_(descriptors),
      address_("unix:" + (folder_ / "weftd.sock").string()) {
  start();
}

void Server::start() {
  const std::string port_file = folder_ / "address";
  std::filesystem::remove(port_file);
  std::vector<std::string> all{"--listen", address_, "--port-file", port_file};
  all.insert(all.end(), arguments_.begin(), arguments_.end());
  std::string program = testing::kWeftd;
  if (descriptors_ != 0) {
    all.insert(all.begin(),
               {"-c", "ulimit -n \"$0\" && exec \"$@\"", std::to_string(descriptors_), program});
    program = "/bin/sh";
  }
  pid_ = e2e::start(program, all, folder_ / "out", folder_ / "err");
  while (!std::filesystem::exists(port_file)) {
    if (waitpid(pid_, nullptr, WNOHANG) != 0) {
      pid_ = -1;
      throw std::runtime_error("weftd did not start:\n" + contents(folder_ / "err"));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

std::vector<std::string> Server::addresses() const {
  std::ifstream in(folder_ / "address");
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

Server::~Server() {
  if (pid_ < 0) return;
  ::kill(pid_, SIGTERM);
  EXPECT_EQ(wait_for(pid_), 0) << "weftd did not drain in peace:\n" << contents(folder_ / "err");
}

void Server::kill() {
  ::kill(pid_, SIGKILL);
  wait_for(pid_);
  pid_ = -1;
}

void Server::freeze() {
  ::kill(pid_, SIGSTOP);
}

void Server::thaw() {
  ::kill(pid_, SIGCONT);
}

std::uint64_t Server::resident_bytes() const {
  std::ifstream statm("/proc/" + std::to_string(pid_) + "/statm");
  std::uint64_t total = 0;
  std::uint64_t resident = 0;
  statm >> total >> resident;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::uint64_t Server::peak_bytes() const {
  std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
  for (std::string word; status >> word;) {
    std::uint64_t kibibytes = 0;
    if (word == "VmHWM:" && status >> kibibytes) return kibibytes * 1024;
  }
  return 0;
}

std::string Server::log() const {
  return contents(folder_ / "err");
}

std::uint64_t Server::logged_bytes() const {
  return std::filesystem::file_size(folder_ / "err");
}

std::size_t Server::open_files() const {
  const std::filesystem::directory_iterator files("/proc/" + std::to_string(pid_) + "/fd");
  return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

double Server::metric(const std::string& series) const {
  const std::string last = addresses().back();
  return weft::testing::value_of(
      weft::testing::http(last.substr(last.find('=') + 1), "GET", "/metrics"), series);
}

bool Server::shows(const std::string& series, double value) const {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (metric(series) != value) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

std::string model(const std::string& name) {
  return std::string(testing::kModels) + "/" + name;
}

}  // namespace weft::e2e

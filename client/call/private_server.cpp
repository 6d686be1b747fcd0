// SPDX-License-Identifier: Apache-2.0
#include "client/call/private_server.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/eventfd.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "files/bytes/file_contents.h"

extern char** environ;

namespace weft::client {
namespace {

tl::unexpected<Error> not_started(const std::string& why) {
  return fail(ExitCode::kServerNotStarted, "no private weftd: " + why);
}

bool is_executable(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) && ::access(path.c_str(), X_OK) == 0;
}

Result<std::filesystem::path> find_weftd(const PrivateServerOptions& options) {
  if (options.weftd) return *options.weftd;
  if (const char* given = std::getenv("WEFT_WEFTD"); given != nullptr && *given != '\0')
    return std::filesystem::path(given);
  std::error_code ignored;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", ignored);
  if (const auto beside = self.parent_path() / "weftd"; is_executable(beside)) return beside;
  const char* path = std::getenv("PATH");
  std::string folders = path != nullptr ? path : "";
  while (!folders.empty()) {
    const std::size_t end = std::min(folders.find(':'), folders.size());
    const auto candidate = std::filesystem::path(folders.substr(0, end)) / "weftd";
    if (end > 0 && is_executable(candidate)) return candidate;
    folders.erase(0, end + 1);
  }
  return not_started(
      "weftd is neither beside weft nor in the PATH; give --server ADDR, or WEFT_WEFTD");
}

// Our environment without the variables of weftd and of weft: this server keeps no jobs, has no
// certificate and its own limits, and a token belongs to a server that is named.
std::vector<char*> its_environment() {
  std::vector<char*> variables;
  for (char** each = environ; *each != nullptr; ++each)
    if (!std::string_view(*each).starts_with("WEFT_")) variables.push_back(*each);
  variables.push_back(nullptr);
  return variables;
}

// Milliseconds until then, as poll takes them.
int milliseconds_until(std::chrono::steady_clock::time_point then) {
  const auto left =
      std::chrono::ceil<std::chrono::milliseconds>(then - std::chrono::steady_clock::now()).count();
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, 1'000'000));
}

}  // namespace

Result<std::unique_ptr<PrivateServer>> PrivateServer::start(
    const PrivateServerOptions& options, std::stop_token stop,
    const std::function<void(const std::string& address)>& meanwhile) {
  const auto weftd = find_weftd(options);
  if (!weftd) return tl::unexpected(weftd.error());
  std::unique_ptr<PrivateServer> server(new PrivateServer(options));
  if (auto made = server->make_folder(); !made) return tl::unexpected(made.error());
  const auto deadline = Clock::now() + options.start_timeout;
  if (auto spawned = server->spawn(*weftd); !spawned) return tl::unexpected(spawned.error());
  if (meanwhile) meanwhile(server->address());
  if (auto ready = server->wait_until_ready(*weftd, deadline, std::move(stop)); !ready)
    return tl::unexpected(ready.error());
  return server;
}

Result<void> PrivateServer::make_folder() {
  const char* given = std::getenv("TMPDIR");
  std::string base = given != nullptr && *given == '/' ? given : "/tmp";
  // The path of a socket must be short.
  constexpr std::size_t kLongest = sizeof(sockaddr_un::sun_path) - sizeof("/weft-XXXXXX/socket");
  if (base.size() > kLongest) base = "/tmp";
  std::string name = base + "/weft-XXXXXX";
  if (::mkdtemp(name.data()) == nullptr)
    return not_started("the folder " + name + ": " + std::strerror(errno));
  folder_ = name;
  return {};
}

Result<void> PrivateServer::spawn(const std::filesystem::path& weftd) {
  int input[2];
  if (::pipe2(input, O_CLOEXEC) != 0) return not_started(std::strerror(errno));
  FileDescriptor its_input(input[0]);
  input_ = FileDescriptor(input[1]);
  int output[2];
  if (::pipe2(output, O_CLOEXEC) != 0) return not_started(std::strerror(errno));
  FileDescriptor its_output(output[1]);
  output_ = FileDescriptor(output[0]);

  const std::string log = folder_ / "log";
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, its_input.get(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, its_output.get(), STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_APPEND, 0600);
  // A process group of its own, so that Ctrl-C reaches this process alone, and no signals that are
  // blocked or ignored.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  posix_spawnattr_setpgroup(&attributes, 0);
  sigset_t signals;
  sigemptyset(&signals);
  posix_spawnattr_setsigmask(&attributes, &signals);
  sigaddset(&signals, SIGPIPE);
  sigaddset(&signals, SIGXFSZ);
  posix_spawnattr_setsigdefault(&attributes, &signals);

  // It writes the address to its standard output when it listens.
  std::vector<std::string> arguments{weftd.string(),      "--listen", address(), "--port-file", "-",
                                     "--exit-with-stdin", "--drain",  "1"};
  if (options_.jobs) arguments.insert(arguments.end(), {"--jobs", std::to_string(*options_.jobs)});
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const int problem = ::posix_spawn(&pid_, weftd.c_str(), &actions, &attributes, argv.data(),
                                    its_environment().data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (problem != 0) {
    pid_ = 0;
    return not_started(weftd.string() + ": " + std::strerror(problem));
  }
  process_ = FileDescriptor(static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0)));
  return {};
}

Result<void> PrivateServer::wait_until_ready(const std::filesystem::path& weftd,
                                             Clock::time_point deadline, std::stop_token stop) {
  FileDescriptor interrupt(::eventfd(0, EFD_CLOEXEC));
  const std::stop_callback wake(stop, [&interrupt] {
    const std::uint64_t one = 1;
    (void)write_all(interrupt.get(), &one, sizeof one);
  });
  pollfd fds[] = {
      {output_.get(), POLLIN, 0}, {process_.get(), POLLIN, 0}, {interrupt.get(), POLLIN, 0}};
  for (;;) {
    const int count = ::poll(fds, 3, milliseconds_until(deadline));
    if (count < 0 && errno == EINTR) continue;
    if ((fds[0].revents & POLLIN) != 0) return {};
    if (fds[0].revents != 0) fds[0].fd = -1;  // closed: the process is about to end
    if (fds[2].revents != 0) return not_started("interrupted");
    if (fds[1].revents != 0)
      return not_started(weftd.string() + " ended at start; it said:\n" + last_log_lines());
    if (count == 0)
      return not_started(weftd.string() + " is not ready after " +
                         std::to_string(options_.start_timeout.count()) + " ms; it said:\n" +
                         last_log_lines());
  }
}

std::string PrivateServer::last_log_lines() const {
  constexpr std::uint64_t kLargestLog = std::uint64_t{64} << 20;
  constexpr int kLines = 10;
  const auto log = read_file(folder_ / "log", kLargestLog);
  if (!log) return "";
  std::string_view text = log->text();
  while (text.ends_with('\n')) text.remove_suffix(1);
  std::size_t start = text.size();
  for (int line = 0; line < kLines && start != std::string_view::npos && start > 0; ++line)
    start = text.rfind('\n', start - 1);
  if (start != std::string_view::npos && start > 0) text.remove_prefix(start + 1);
  if (text.empty()) return "";
  std::string out = "  ";
  for (const char c : text) {
    out += c;
    if (c == '\n') out += "  ";
  }
  return out;
}

PrivateServer::~PrivateServer() {
  if (pid_ != 0) {
    ::kill(pid_, SIGKILL);
    while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  std::error_code ignored;
  if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
}

}  // namespace weft::client

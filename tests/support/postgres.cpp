// SPDX-License-Identifier: Apache-2.0
#include "tests/support/postgres.h"

#include <fcntl.h>
#include <libpq-fe.h>
#include <pwd.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <thread>

#include "tests/support/event.h"

namespace weft {
namespace {

constexpr const char* kUser = "postgres";

// Waits until the pipe closes, that is until the program has ended which made it; then ends the
// server, if it still runs, and removes its folder. In the background and in a session of its own,
// so that whoever ends the program with all its children or its process group does not end this. A
// shell gives what runs in the background nothing to read, unless it is told otherwise.
constexpr const char* kJanitor = R"sh(
exec 3<&0
( cat <&3
  pid=$(head -n 1 "$0/data/postmaster.pid" 2> /dev/null) && kill -QUIT "$pid" 2> /dev/null
  while [ -n "$pid" ] && kill -0 "$pid" 2> /dev/null; do sleep 0.1; done
  rm -rf "$0" ) > /dev/null 2>&1 &
)sh";

void wait_for_end(pid_t pid) {
  while (waitpid(pid, nullptr, 0) < 0 && errno == EINTR) {
  }
}

}  // namespace

PostgresServer::PostgresServer(const std::filesystem::path& parent) : folder_(parent) {
  clean_up_after_a_crash();
  if (geteuid() == 0) {
    const passwd* const user = getpwnam(kUser);
    if (user == nullptr) throw std::runtime_error("there is no user postgres to run a server as");
    if (chown(folder_.path().c_str(), user->pw_uid, user->pw_gid) != 0) {
      throw std::runtime_error("cannot give a folder to the user postgres");
    }
  }
  run(as_its_user({WEFT_INITDB, "--pgdata", (folder_ / "data").string(), "--username", kUser,
                   "--auth", "trust", "--no-sync", "--encoding", "UTF8", "--locale", "C"}));
  start();
}

PostgresServer::~PostgresServer() {
  if (pid_ > 0) {
    ::kill(pid_, SIGQUIT);
    wait_for_end(pid_);
  }
  close(alive_);
}

void PostgresServer::clean_up_after_a_crash() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) fail("no pipe");
  alive_ = ends[1];
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  posix_spawnattr_t own_session;
  posix_spawnattr_init(&own_session);
  posix_spawnattr_setflags(&own_session, POSIX_SPAWN_SETSID);
  const char* const arguments[] = {"sh", "-c", kJanitor, folder_.path().c_str(), nullptr};
  pid_t shell = -1;
  const int error = posix_spawn(&shell, "/bin/sh", &actions, &own_session,
                                const_cast<char* const*>(arguments), environ);
  posix_spawnattr_destroy(&own_session);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[0]);
  if (error != 0) fail("no shell");
  wait_for_end(shell);
}

std::vector<std::string> PostgresServer::as_its_user(std::vector<std::string> command) const {
  std::vector<std::string> whole{"setpriv", "--pdeathsig", "QUIT"};
  if (geteuid() == 0) {
    for (const char* option : {"--reuid", kUser, "--regid", kUser, "--init-groups"}) {
      whole.emplace_back(option);
    }
  }
  whole.emplace_back("--");
  whole.insert(whole.end(), command.begin(), command.end());
  return whole;
}

pid_t PostgresServer::spawn(const std::vector<std::string>& command) const {
  std::vector<char*> arguments;
  for (const std::string& argument : command) {
    arguments.push_back(const_cast<char*>(argument.c_str()));
  }
  arguments.push_back(nullptr);
  const std::string log = (folder_ / "log").string();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_APPEND, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t pid = -1;
  const int error = posix_spawnp(&pid, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) fail("cannot run " + command[0]);
  return pid;
}

void PostgresServer::run(const std::vector<std::string>& command) const {
  int status = 0;
  if (waitpid(spawn(command), &status, 0) < 0 || status != 0) fail("initdb has failed");
}

void PostgresServer::fail(const std::string& what) const {
  std::ifstream log(folder_ / "log");
  throw std::runtime_error("PostgreSQL: " + what + "\n" +
                           std::string(std::istreambuf_iterator<char>(log), {}));
}

std::string PostgresServer::uri(const std::string& database) const {
  std::string host;
  for (const char character : folder_.path().string()) {
    host += character == '/' ? std::string("%2F") : std::string(1, character);
  }
  return "postgres:///" + database + "?host=" + host + "&user=" + kUser;
}

void PostgresServer::start() {
  const std::vector<std::string> command =
      as_its_user({WEFT_POSTGRES, "-D", (folder_ / "data").string(), "-k", folder_.path().string(),
                   "-c", "listen_addresses=", "-c", "fsync=off", "-c", "full_page_writes=off", "-c",
                   "shared_buffers=32MB", "-c", "max_wal_size=64MB", "-c", "min_wal_size=32MB",
                   "-c", "autovacuum=off"});
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (PQping(uri("postgres").c_str()) != PQPING_OK) {
    if (std::chrono::steady_clock::now() > end) fail("the server does not answer");
    // After a kill it refuses to start until the last of its old processes has noticed.
    const bool ended = pid_ > 0 && waitpid(pid_, nullptr, WNOHANG) == pid_;
    if (pid_ < 0 || ended) pid_ = spawn(command);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

void PostgresServer::stop() {
  ::kill(pid_, SIGINT);
  wait_for_end(pid_);
  pid_ = -1;
}

void PostgresServer::kill() {
  ::kill(pid_, SIGKILL);
  wait_for_end(pid_);
  pid_ = -1;
}

void PostgresServer::signal_all(int signal) const {
  std::vector<pid_t> all{pid_};
  const std::string pid = std::to_string(pid_);
  std::ifstream children("/proc/" + pid + "/task/" + pid + "/children");
  for (pid_t child = 0; children >> child;) all.push_back(child);
  for (const pid_t process : all) ::kill(process, signal);
}

std::string PostgresServer::new_database() {
  const std::string name = "test" + std::to_string(databases_++);
  execute(uri("postgres"), "CREATE DATABASE " + name);
  return uri(name);
}

void PostgresServer::drop_database(const std::string& dropped) {
  for (int i = 0; i < databases_; ++i) {
    const std::string name = "test" + std::to_string(i);
    if (uri(name) != dropped) continue;
    execute(uri("postgres"), "DROP DATABASE " + name + " WITH (FORCE)");
  }
}

void PostgresServer::execute(const std::string& database, const std::string& sql) {
  try {
    PostgresSession(database).run(sql);
  } catch (const std::runtime_error& error) {
    fail(error.what());
  }
}

PostgresSession::PostgresSession(const std::string& uri)
    : connection_(PQconnectdb(uri.c_str()), PQfinish) {}

std::string PostgresSession::run(const std::string& sql) {
  const std::unique_ptr<PGresult, void (*)(PGresult*)> result(
      PQexec(connection_.get(), sql.c_str()), PQclear);
  const ExecStatusType status = PQresultStatus(result.get());
  if (status != PGRES_COMMAND_OK && status != PGRES_TUPLES_OK)
    throw std::runtime_error(sql + ": " + PQerrorMessage(connection_.get()));
  return PQntuples(result.get()) > 0 ? PQgetvalue(result.get(), 0, 0) : "";
}

}  // namespace weft

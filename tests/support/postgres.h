// SPDX-License-Identifier: Apache-2.0
// A real PostgreSQL server, started by a test in a fresh folder, and reached through a Unix socket
// there. It ends with the test program, in whatever way that ends, and its folder goes with it.
//
// It runs as the user `postgres` where the test runs as root, for it refuses to be root. What is
// written does not wait for the disk: it survives a kill of the server, not of the machine.
//
// Failures throw std::runtime_error, with what the server has said.
//
//   PostgresServer server;
//   const std::string uri = server.new_database();   // postgres:///...
//   server.kill(); server.start();                   // what was committed is there
#pragma once

#include <signal.h>
#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tests/files/support/temp_folder.h"

typedef struct pg_conn PGconn;  // of libpq-fe.h

namespace weft {

class PostgresServer {
 public:
  explicit PostgresServer(
      const std::filesystem::path& parent = std::filesystem::temp_directory_path());
  ~PostgresServer();
  PostgresServer(const PostgresServer&) = delete;
  PostgresServer& operator=(const PostgresServer&) = delete;

  // An empty database of its own.
  std::string new_database();
  void drop_database(const std::string& uri);
  // SQL in a database.
  void execute(const std::string& uri, const std::string& sql);

  void start();
  void stop();  // ends all connections
  void kill();  // with SIGKILL, as if the machine's memory were lost but not its disk
  void restart() {
    stop();
    start();
  }
  // Stops it and all its processes where they are, as if the network were gone, and lets them go
  // on.
  void freeze() const { signal_all(SIGSTOP); }
  void thaw() const { signal_all(SIGCONT); }

 private:
  std::vector<std::string> as_its_user(std::vector<std::string> command) const;
  // What it has printed is in the log.
  pid_t spawn(const std::vector<std::string>& command) const;
  void run(const std::vector<std::string>& command) const;
  void signal_all(int signal) const;
  [[noreturn]] void fail(const std::string& what) const;
  std::string uri(const std::string& database) const;
  void clean_up_after_a_crash();

  const files::TempFolder folder_;
  int alive_ = -1;  // the end of a pipe: it closes when this program ends
  pid_t pid_ = -1;  // -1: it does not run
  int databases_ = 0;
};

// A connection that keeps its transaction from one statement to the next.
class PostgresSession {
 public:
  explicit PostgresSession(const std::string& uri);
  // The first value of the answer, as text; empty if there is none. Throws if it fails.
  std::string run(const std::string& sql);

 private:
  const std::unique_ptr<PGconn, void (*)(PGconn*)> connection_;
};

}  // namespace weft

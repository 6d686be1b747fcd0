// SPDX-License-Identifier: Apache-2.0
// The real programs, run as a user runs them.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

#include "tests/files/support/temp_folder.h"

namespace weft::e2e {

using Folder = files::TempFolder;

// Starts build/.../weft with these arguments; what it says goes to nobody.
pid_t start_weft(const std::vector<std::string>& arguments);

struct Outcome {
  int exit_code = -1;  // 128 + n for a signal
  std::string out;
  std::string err;
  std::uint64_t peak_bytes = 0;  // of its resident memory
};

// Runs build/.../weft with these arguments and waits.
Outcome run_weft(const std::vector<std::string>& arguments);
// Any program, by its path.
Outcome run_program(const std::string& program, const std::vector<std::string>& arguments);

// A weftd on a unix socket; SIGTERM at the end, after which it must exit with 0.
class Server {
 public:
  // `descriptors`: how many it may have, by its hard limit; 0: as many as the test.
  explicit Server(const std::vector<std::string>& arguments = {}, unsigned descriptors = 0);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  const std::string& address() const { return address_; }
  // All of them, as its port file tells.
  std::vector<std::string> addresses() const;
  void kill();  // SIGKILL, and waits
  void freeze();
  void thaw();
  // Starts it again, where it was and as it was. REQUIRES: killed.
  void start();
  std::uint64_t resident_bytes() const;
  // The most that it ever had.
  std::uint64_t peak_bytes() const;
  // What it wrote to stderr since it was started last.
  std::string log() const;
  std::uint64_t logged_bytes() const;
  std::size_t open_files() const;
  // The value of a metric, see value_of. REQUIRES: --metrics.
  double metric(const std::string& series) const;
  // Whether it comes to be this value; looks for a minute.
  bool shows(const std::string& series, double value) const;

 private:
  const std::vector<std::string> arguments_;
  const unsigned descriptors_;
  Folder folder_;
  std::string address_;
  pid_t pid_ = -1;
};

// The path of a file in tests/models.
std::string model(const std::string& name);

}  // namespace weft::e2e

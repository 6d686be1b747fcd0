// SPDX-License-Identifier: GPL-3.0-or-later
// A weftd of the benchmark's own, on a unix socket and on a port of the loopback.
//
// It ends with this object, and with this process.
//
//   auto server = WeftdProcess::start("build/release/weftd", 2);
//   auto channel = grpc::CreateChannel(server->unix_address(), ...);
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <string>

#include "tests/files/support/temp_folder.h"

namespace weft::bench {

class WeftdProcess {
 public:
  // Waits until it listens. Null when it does not, with the reason on stderr.
  static std::unique_ptr<WeftdProcess> start(const std::string& weftd, int threads);
  ~WeftdProcess();
  WeftdProcess(const WeftdProcess&) = delete;
  WeftdProcess& operator=(const WeftdProcess&) = delete;

  const std::string& unix_address() const { return unix_address_; }
  const std::string& tcp_address() const { return tcp_address_; }
  // The most memory that it has had, in bytes.
  std::uint64_t peak_bytes() const;

 private:
  WeftdProcess() = default;
  bool spawn(const std::string& weftd, int threads);
  bool wait_until_ready();

  files::TempFolder folder_;  // outlives the process
  std::string unix_address_;
  std::string tcp_address_;
  pid_t pid_ = 0;
  int its_input_ = -1;
};

}  // namespace weft::bench

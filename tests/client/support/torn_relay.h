// SPDX-License-Identifier: Apache-2.0
// A wire that tears: listens on a unix socket, passes what comes to another one, and closes the
// first connections after so many bytes of the answers, wherever in a message that is. Later
// connections hold.
//
//   TornRelay relay(folder / "wire", folder / "server", {1000, 70'000});
//   ... clients of relay.address() ...
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "client/base/files.h"
#include "files/base/atomic_file.h"

namespace weft::client {

class TornRelay {
 public:
  TornRelay(const std::filesystem::path& wire, std::filesystem::path server,
            std::vector<std::size_t> tears);
  ~TornRelay();
  TornRelay(const TornRelay&) = delete;
  TornRelay& operator=(const TornRelay&) = delete;

  const std::string& address() const { return address_; }
  // Closes the connection at hand, if there is one.
  void tear();
  // Connections that were closed at their tear, so far.
  std::size_t torn() const { return torn_; }

 private:
  void run();
  // Passes bytes both ways until an end closes, `limit` bytes were answered, or all is over. True:
  // the limit was reached.
  bool pass(const FileDescriptor& client, std::size_t limit);
  void hold(int client);

  const std::string address_;
  const std::filesystem::path server_;
  const std::vector<std::size_t> tears_;
  FileDescriptor listener_;
  FileDescriptor end_;  // readable: all is over
  std::atomic<std::size_t> torn_{0};
  std::mutex mutex_;  // guards the one below
  int client_ = -1;   // of the connection at hand
  std::thread thread_;
};

}  // namespace weft::client

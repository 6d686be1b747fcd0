// SPDX-License-Identifier: Apache-2.0
// Stands between a store and its database, and cuts a connection at the worst moment: when a
// commit has been done, and its answer is on the way.
#pragma once

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "tests/files/support/temp_folder.h"

namespace weft::server {

class CuttingProxy {
 public:
  // `uri` as PostgresServer gives it.
  explicit CuttingProxy(const std::string& uri);
  ~CuttingProxy();
  CuttingProxy(const CuttingProxy&) = delete;
  CuttingProxy& operator=(const CuttingProxy&) = delete;

  const std::string& uri() const { return uri_; }
  // The next so many commits lose their answers.
  void cut(int commits) { cuts_ = commits; }

 private:
  void accept_all();
  void serve(int client);

  const files::TempFolder folder_;
  std::string server_;  // the path of its socket
  std::string uri_;
  int listening_ = -1;
  std::atomic<int> cuts_ = 0;
  std::atomic<bool> stopping_ = false;
  std::thread accepting_;
  std::vector<std::thread> serving_;
};

}  // namespace weft::server

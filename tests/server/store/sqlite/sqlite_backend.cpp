// SPDX-License-Identifier: Apache-2.0
#include <atomic>

#include "server/store/sqlite/sqlite_store.h"
#include "tests/client/support/temp_folder.h"
#include "tests/server/store/backend.h"

namespace weft::server {
namespace {

class SqliteBackend final : public Backend {
 public:
  StoreResult<std::unique_ptr<JobStore>> open() override {
    return SqliteStore::open({.folder = (folder_ / "store").string(), .clock = [this] {
                                return std::chrono::system_clock::now() + ahead_.load();
                              }});
  }
  void pass(std::chrono::microseconds time) override { ahead_ = ahead_.load() + time; }

 private:
  const client::TempFolder folder_{folder_for_tests()};
  std::atomic<std::chrono::microseconds> ahead_{std::chrono::microseconds(0)};
};

}  // namespace

std::unique_ptr<Backend> make_sqlite_backend() {
  return std::make_unique<SqliteBackend>();
}

}  // namespace weft::server

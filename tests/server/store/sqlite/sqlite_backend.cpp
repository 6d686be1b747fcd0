// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <atomic>
#include <string>

#include "server/store/sqlite/sqlite_store.h"
#include "tests/files/support/temp_folder.h"
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
  void damage(const std::string& sha256, const std::string& bytes) override {
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open((folder_ / "store/weft.db").c_str(), &database), SQLITE_OK);
    sqlite3_busy_timeout(database, 10'000);
    const std::string sql = "UPDATE chunk_bytes SET bytes = x'" + hex(bytes) +
                            "' WHERE chunk = (SELECT id FROM chunk WHERE sha256 = x'" +
                            hex(sha256) + "')";
    EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK);
    EXPECT_EQ(sqlite3_changes(database), 1);
    sqlite3_close(database);
  }

 private:
  const files::TempFolder folder_{folder_for_tests()};
  std::atomic<std::chrono::microseconds> ahead_{std::chrono::microseconds(0)};
};

}  // namespace

std::unique_ptr<Backend> make_sqlite_backend() {
  return std::make_unique<SqliteBackend>();
}

}  // namespace weft::server

// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "server/store/postgres/postgres_store.h"
#include "tests/server/store/backend.h"
#include "tests/support/postgres.h"

namespace weft::server {
namespace {

class PostgresBackend final : public Backend {
 public:
  PostgresBackend() : uri_(the_database()) {}
  // To empty a database takes a tenth of the time that it takes to make one.
  ~PostgresBackend() override {
    postgres_server().execute(
        uri_,
        "DELETE FROM weft_job; DELETE FROM weft_task; DELETE FROM weft_served;"
        "DELETE FROM weft_settled; DELETE FROM weft_mesh;"
        "DELETE FROM weft_chunk;");
  }

  StoreResult<std::unique_ptr<JobStore>> open() override {
    return PostgresStore::open({.uri = uri_});
  }

  // The clock is the database's: what is stored moves into the past.
  void pass(std::chrono::microseconds time) override {
    const std::string by = " - interval '" + std::to_string(time.count()) + " microseconds'";
    std::string sql;
    for (const auto& [table, columns] : kTimes) {
      sql += std::string("UPDATE ") + table + " SET ";
      for (const char* column : columns) {
        if (column != nullptr) sql += std::string(column) + " = " + column + by + ", ";
      }
      sql.resize(sql.size() - 2);
      sql += ";";
    }
    postgres_server().execute(uri_, sql);
  }

  void damage(const std::string& sha256, const std::string& bytes) override {
    postgres_server().execute(uri_, "UPDATE weft_chunk SET bytes = '\\x" + hex(bytes) +
                                        "' WHERE sha256 = '\\x" + hex(sha256) + "'");
  }

 private:
  struct Times {
    const char* table;
    const char* columns[4];
  };
  static constexpr Times kTimes[] = {{"weft_task", {"created", "due", "started", "lease_end"}},
                                     {"weft_job", {"created", "started", "ended", "callback_due"}},
                                     {"weft_settled", {"at", nullptr, nullptr, nullptr}},
                                     {"weft_mesh", {"asked", nullptr, nullptr, nullptr}},
                                     {"weft_chunk", {"touched", nullptr, nullptr, nullptr}}};

  static const std::string& the_database() {
    static const std::string uri = postgres_server().new_database();
    return uri;
  }

  const std::string uri_;
};

}  // namespace

PostgresServer& postgres_server() {
  static PostgresServer server(folder_for_tests());
  return server;
}

std::unique_ptr<Backend> make_postgres_backend() {
  return std::make_unique<PostgresBackend>();
}

}  // namespace weft::server

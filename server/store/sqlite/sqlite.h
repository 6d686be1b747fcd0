// SPDX-License-Identifier: Apache-2.0
// A thin layer over SQLite: connections, transactions and rows that clean up after themselves. It
// knows nothing of jobs.
//
// A transaction keeps its first error: once a statement has failed, those after it do nothing and
// return no rows, and `commit` returns that error. So code need not check every statement, but
// must not rely on missing rows until `commit` has succeeded.
//
// Thread-safety: a connection and all that it returns belong to one thread at a time.
//
//   Transaction transaction(connection, Access::kWrite);
//   Rows rows = transaction.run("SELECT name FROM pet WHERE id = ?1", 7);
//   const std::string name = rows.next() ? rows.bytes(0) : "nobody";
//   transaction.run("DELETE FROM pet WHERE id = ?1", 7).next();
//   return transaction.commit();
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include "server/store/store_error.h"

namespace weft::server::sqlite {

enum class Access { kRead, kWrite };

// A parameter that is bound as a blob, which never equals a text of the same bytes.
struct Blob {
  std::string_view bytes;
};

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
};
struct FinalizeStatement {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};

class Connection {
 public:
  // Makes the file if it is missing and `access` is kWrite.
  static StoreResult<std::unique_ptr<Connection>> open(const std::string& path, Access access);

  // One or more statements without parameters, outside of a transaction.
  StoreResult<void> execute(const char* sql);
  // The number that a PRAGMA returns.
  StoreResult<std::int64_t> pragma(const char* sql);

 private:
  friend class Transaction;
  friend class Rows;

  explicit Connection(sqlite3* database) : database_(database) {}
  StoreError error(int code) const;
  // Compiled once per connection and text. Null if it does not compile.
  sqlite3_stmt* statement(std::string_view sql);

  std::unique_ptr<sqlite3, CloseDatabase> database_;
  // By their own texts. Destroyed before the database.
  std::unordered_map<std::string_view, std::unique_ptr<sqlite3_stmt, FinalizeStatement>>
      statements_;
};

class Transaction;

// The result of a statement, row by row; it does not run before the first `next`. Only one at a
// time per statement.
class Rows {
 public:
  ~Rows();
  Rows(const Rows&) = delete;
  Rows& operator=(const Rows&) = delete;

  // Returns false after the last row, and if the transaction has failed.
  bool next();

  // Values of the current row; columns count from 0.
  bool null(int column) const;
  std::int64_t integer(int column) const;  // 0 if null
  std::string bytes(int column) const;     // of texts and blobs; empty if null

 private:
  friend class Transaction;
  Rows(Transaction& transaction, sqlite3_stmt* statement)
      : transaction_(transaction), statement_(statement) {}

  Transaction& transaction_;
  sqlite3_stmt* statement_;  // null: no rows
};

class Transaction {
 public:
  Transaction(Connection& connection, Access access);
  // Rolls back unless committed.
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;

  // Parameters are ?1, ?2, ... The texts and blobs must live as long as the rows.
  template <class... Arguments>
  Rows run(std::string_view sql, const Arguments&... arguments) {
    sqlite3_stmt* const statement = error_ ? nullptr : prepare(sql);
    [[maybe_unused]] int parameter = 0;
    if (statement != nullptr) (check(bind(statement, ++parameter, arguments)), ...);
    return {*this, error_ ? nullptr : statement};
  }
  // Runs a statement for its effect; returns the number of changed rows.
  template <class... Arguments>
  std::int64_t change(std::string_view sql, const Arguments&... arguments) {
    const std::int64_t before = changes();
    run(sql, arguments...).next();
    return changes() - before;
  }

  // Reads a whole blob straight into the string. Fails if there is no such row.
  std::string blob(const char* table, const char* column, std::int64_t row);

  // Rows changed since the beginning.
  std::int64_t changes() const;
  void fail(StoreError error);
  bool failed() const { return error_.has_value(); }
  StoreResult<void> commit();

 private:
  friend class Rows;

  static int bind(sqlite3_stmt* statement, int parameter, std::int64_t value);
  static int bind(sqlite3_stmt* statement, int parameter, std::string_view text);
  static int bind(sqlite3_stmt* statement, int parameter, Blob blob);
  static int bind(sqlite3_stmt* statement, int parameter, std::nullptr_t);
  template <class T>
  static int bind(sqlite3_stmt* statement, int parameter, const std::optional<T>& value) {
    return value ? bind(statement, parameter, *value) : bind(statement, parameter, nullptr);
  }

  sqlite3_stmt* prepare(std::string_view sql);
  bool check(int code);  // if the code is an error, keeps it and returns false

  Connection& connection_;
  const std::int64_t changes_before_;
  bool open_ = false;
  std::optional<StoreError> error_;
};

}  // namespace weft::server::sqlite

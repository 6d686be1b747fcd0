// SPDX-License-Identifier: Apache-2.0
// A thin layer over libpq: connections, transactions and rows that clean up after themselves. It
// knows nothing of jobs. Parameters and results are sent as binary.
//
// A transaction keeps its first error: once a statement has failed, those after it do nothing and
// return no rows, and `commit` returns that error. So code need not check every statement, but
// must not rely on missing rows until `commit` has succeeded.
//
// No call waits for ever: the database cancels a statement after `statement_timeout`; if it does
// not, the connection is closed after twice as long.
//
// Thread-safety: a connection and all that it returns belong to one thread at a time.
//
//   Transaction transaction(connection, Begin::kDurable);
//   Rows rows = transaction.run("SELECT name FROM pet WHERE id = $1", 7);
//   const std::string name = rows.next() ? rows.bytes(0) : "nobody";
//   transaction.change("DELETE FROM pet WHERE id = $1", 7);
//   return transaction.commit();
#pragma once

#include <chrono>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "server/store/postgres/libpq.h"
#include "server/store/store_error.h"

namespace weft::server::postgres {

struct Blob {
  std::string_view bytes;
};

// A parameter, as PostgreSQL reads it.
class Value {
 public:
  Value(std::int64_t number);
  Value(int number) : Value(std::int64_t{number}) {}
  Value(std::uint32_t number) : Value(std::int64_t{number}) {}
  Value(bool truth);
  Value(std::string_view text);
  Value(const std::string& text) : Value(std::string_view(text)) {}
  Value(const char* text) : Value(std::string_view(text)) {}
  Value(Blob blob);
  template <class T>
  Value(const std::optional<T>& value) : Value(value ? Value(*value) : null_like(Value(T()))) {}

 private:
  friend class Connection;
  static Value null_like(Value value);

  Oid type_;
  bool null_ = false;
  std::string_view bytes_;  // of texts and blobs, which are not copied
  char number_[8] = {};     // other values, the highest byte first
  int size_ = 0;
};

struct ClearResult {
  void operator()(PGresult* result) const { libpq().PQclear(result); }
};
struct FinishConnection {
  void operator()(PGconn* connection) const { libpq().PQfinish(connection); }
};
using Result = std::unique_ptr<PGresult, ClearResult>;

class Connection {
 public:
  struct Options {
    std::string uri;  // or a connection string of libpq
    std::chrono::seconds connect_timeout{5};
    std::chrono::milliseconds statement_timeout{30'000};
  };
  static StoreResult<std::unique_ptr<Connection>> open(const Options& options);

  // One or more statements without parameters.
  StoreResult<void> execute(const char* sql);
  // The same without a time limit, for statements that run once.
  StoreResult<void> execute_patiently(const char* sql);

  bool broken() const { return broken_ || libpq().PQstatus(connection_.get()) != CONNECTION_OK; }

  // For notifications: the descriptor to wait for, and the payload of the next one that arrived.
  int socket() const { return libpq().PQsocket(connection_.get()); }
  std::optional<std::string> next_notification();

 private:
  friend class Transaction;

  Connection(PGconn* connection, std::chrono::milliseconds statement_timeout)
      : connection_(connection), patience_(2 * statement_timeout) {}
  StoreResult<Result> run(const char* sql, std::initializer_list<Value> values);
  StoreResult<Result> answer(bool sent, std::chrono::milliseconds patience);
  StoreError error(const PGresult* result);

  std::unique_ptr<PGconn, FinishConnection> connection_;
  const std::chrono::milliseconds patience_;
  bool broken_ = false;  // given up, whatever libpq says
  std::string state_;    // SQLSTATE of the last error from the server
};

// The result of a statement, row by row.
class Rows {
 public:
  // Returns false after the last row, and if the transaction has failed.
  bool next();

  // Values of the current row; columns count from 0.
  bool null(int column) const;
  std::int64_t integer(int column) const;  // of bigint and boolean; 0 if null
  std::string bytes(int column) const;     // of text and bytea; empty if null

 private:
  friend class Transaction;
  explicit Rows(Result result) : result_(std::move(result)) {}

  Result result_;  // null: no rows
  int row_ = -1;
};

// How a transaction begins.
enum class Begin {
  kOneStatement,  // the transaction is one statement, which commits it
  kDurable,       // the commit waits for the disk
  kLater,         // the commit does not wait; a later durable one writes it, too
};

class Transaction {
 public:
  Transaction(Connection& connection, Begin begin);
  // Rolls back unless committed.
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;

  // Parameters are $1, $2, ...
  template <class... Arguments>
  Rows run(const char* sql, const Arguments&... arguments) {
    return Rows(take(sql, {Value(arguments)...}));
  }
  // Runs a statement for its effect; returns the number of changed rows.
  template <class... Arguments>
  std::int64_t change(const char* sql, const Arguments&... arguments) {
    return count(take(sql, {Value(arguments)...}));
  }

  // Sends a notification with the commit. Call at most once.
  void notify(std::string_view channel, std::string_view payload);

  bool notifies() const { return !notification_.empty(); }

  void fail(StoreError error);
  bool failed() const { return error_.has_value(); }
  StoreResult<void> commit();

  // Whether a failed transaction may succeed if it is repeated at once: true if the connection
  // broke or if two transactions collided.
  bool may_succeed_again() const { return collided_ || connection_.broken(); }
  // Whether it is unknown if it was committed: the connection broke during the commit.
  bool ambiguous() const { return ambiguous_; }

 private:
  Result take(const char* sql, std::initializer_list<Value> values);
  static std::int64_t count(const Result& result);

  Connection& connection_;
  const Begin begin_;
  bool open_ = false;
  bool ambiguous_ = false;
  bool collided_ = false;
  std::string notification_;  // the statement
  std::optional<StoreError> error_;
};

}  // namespace weft::server::postgres

// SPDX-License-Identifier: Apache-2.0
// A thin layer over libpq: connections, transactions and rows that end by themselves. It knows
// nothing of what is stored. Parameters and results travel as binary.
//
// Errors stick to a transaction: once a statement has failed, those after it do nothing and give no
// rows, and `commit` answers with the first error. So the code between reads straight down; what it
// concludes from rows that are missing is worth nothing until `commit` has succeeded.
//
// No call waits for ever: the server gives a statement up after `statement_timeout`, and a server
// that does not even do that is given up after twice as long, with the connection.
//
// Thread-safety: a connection and all that comes of it belong to one thread at a time.
//
//   Transaction transaction(connection, Begin::kDurable);
//   Rows rows = transaction.run("SELECT name FROM pet WHERE id = $1", 7);
//   const std::string name = rows.next() ? rows.bytes(0) : "nobody";
//   transaction.change("DELETE FROM pet WHERE id = $1", 7);
//   return transaction.commit();
#pragma once

#include <libpq-fe.h>

#include <chrono>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

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
  char number_[8] = {};     // of all others, the highest byte first
  int size_ = 0;
};

struct ClearResult {
  void operator()(PGresult* result) const { PQclear(result); }
};
struct FinishConnection {
  void operator()(PGconn* connection) const { PQfinish(connection); }
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
  // Without the limit on time, for what is done once.
  StoreResult<void> execute_patiently(const char* sql);

  bool broken() const { return broken_ || PQstatus(connection_.get()) != CONNECTION_OK; }

  // For notifications: the descriptor to wait for, and the next one that has arrived (its payload).
  int socket() const { return PQsocket(connection_.get()); }
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
  std::string state_;    // of the last error that the server told, an SQLSTATE
};

// What a statement gave, row by row.
class Rows {
 public:
  // False behind the last row, and where the transaction has failed.
  bool next();

  // Of the row that `next` has reached, columns from 0.
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
  kOneStatement,  // it is that one statement, and commits with it
  kDurable,       // the commit waits for the disk
  kLater,         // it does not; one that does takes along all that came before it
};

class Transaction {
 public:
  Transaction(Connection& connection, Begin begin);
  // Undoes everything unless it was committed.
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;

  // Parameters are $1, $2, ...
  template <class... Arguments>
  Rows run(const char* sql, const Arguments&... arguments) {
    return Rows(take(sql, {Value(arguments)...}));
  }
  // For its effect: the number of rows that were changed.
  template <class... Arguments>
  std::int64_t change(const char* sql, const Arguments&... arguments) {
    return count(take(sql, {Value(arguments)...}));
  }

  // Sends a notification with the commit. Once, or not at all.
  void notify(std::string_view channel, std::string_view payload);

  bool notifies() const { return !notification_.empty(); }

  void fail(StoreError error);
  bool failed() const { return error_.has_value(); }
  StoreResult<void> commit();

  // Of one that has failed: whether the same may succeed at once, in another transaction. So it is
  // where the connection broke, and where two transactions stood in each other's way.
  bool may_succeed_again() const { return collided_ || connection_.broken(); }
  // Whether nobody knows if it was committed: the connection broke when it was about to be.
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

// SPDX-License-Identifier: Apache-2.0
#include "server/store/sqlite/sqlite.h"

#include <cerrno>
#include <cstring>
#include <utility>

namespace weft::server::sqlite {
namespace {

// Other processes may look into the file, and a checkpoint waits for those who read.
constexpr int kBusyMs = 10'000;

// SQLite reports most failed writes as an I/O error; errno says why.
bool is_full(int code, int system_error) {
  return code == SQLITE_FULL ||
         (code == SQLITE_IOERR &&
          (system_error == ENOSPC || system_error == EDQUOT || system_error == EFBIG));
}

StoreError explain(sqlite3* database, int extended) {
  // SQLite keeps errno for a failed statement, but not for a failed commit.
  const int latest = errno;
  const int kept = database == nullptr ? 0 : sqlite3_system_errno(database);
  const int system_error = kept != 0 ? kept : latest;
  const int code = extended & 0xff;
  StoreErrorKind kind = StoreErrorKind::kUnavailable;
  if (is_full(code, system_error)) kind = StoreErrorKind::kFull;
  if (code == SQLITE_CORRUPT || code == SQLITE_NOTADB) kind = StoreErrorKind::kBroken;
  std::string message = "SQLite: ";
  message += database == nullptr ? sqlite3_errstr(extended) : sqlite3_errmsg(database);
  message += " (" + std::to_string(extended);
  if (code == SQLITE_IOERR || code == SQLITE_FULL || code == SQLITE_CANTOPEN) {
    message += std::string(", ") + std::strerror(system_error);
  }
  return {kind, message + ")"};
}

}  // namespace

StoreResult<std::unique_ptr<Connection>> Connection::open(const std::string& path, Access access) {
  sqlite3* database = nullptr;
  const int flags =
      access == Access::kWrite ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE : SQLITE_OPEN_READONLY;
  const int code = sqlite3_open_v2(path.c_str(), &database, flags | SQLITE_OPEN_NOMUTEX, nullptr);
  std::unique_ptr<Connection> connection(new Connection(database));
  if (code != SQLITE_OK) {
    StoreError error = explain(database, code);
    error.message = path + ": " + error.message;
    return tl::unexpected(std::move(error));
  }
  sqlite3_extended_result_codes(database, 1);
  sqlite3_busy_timeout(database, kBusyMs);
  return connection;
}

StoreError Connection::error(int code) const {
  return explain(database_.get(), code);
}

StoreResult<void> Connection::execute(const char* sql) {
  const int code = sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) return tl::unexpected(error(code));
  return {};
}

StoreResult<std::int64_t> Connection::pragma(const char* sql) {
  sqlite3_stmt* raw = nullptr;
  int code = sqlite3_prepare_v2(database_.get(), sql, -1, &raw, nullptr);
  const std::unique_ptr<sqlite3_stmt, FinalizeStatement> statement(raw);
  if (code == SQLITE_OK) code = sqlite3_step(raw);
  if (code != SQLITE_ROW) return tl::unexpected(error(code));
  return sqlite3_column_int64(raw, 0);
}

sqlite3_stmt* Connection::statement(std::string_view sql) {
  const auto found = statements_.find(sql);
  if (found != statements_.end()) return found->second.get();
  sqlite3_stmt* made = nullptr;
  sqlite3_prepare_v3(database_.get(), sql.data(), static_cast<int>(sql.size()),
                     SQLITE_PREPARE_PERSISTENT, &made, nullptr);
  if (made != nullptr) statements_.emplace(sqlite3_sql(made), made);
  return made;
}

Rows::~Rows() {
  if (statement_ == nullptr) return;
  sqlite3_reset(statement_);
  sqlite3_clear_bindings(statement_);
}

bool Rows::next() {
  if (statement_ == nullptr || transaction_.failed()) return false;
  const int code = sqlite3_step(statement_);
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) transaction_.check(code);
  // Another step would run it again.
  sqlite3_reset(statement_);
  sqlite3_clear_bindings(statement_);
  statement_ = nullptr;
  return false;
}

bool Rows::null(int column) const {
  return sqlite3_column_type(statement_, column) == SQLITE_NULL;
}

std::int64_t Rows::integer(int column) const {
  return sqlite3_column_int64(statement_, column);
}

std::string Rows::bytes(int column) const {
  const void* const data = sqlite3_column_blob(statement_, column);
  const int size = sqlite3_column_bytes(statement_, column);
  return data == nullptr ? std::string()
                         : std::string(static_cast<const char*>(data), static_cast<size_t>(size));
}

Transaction::Transaction(Connection& connection, Access access)
    : connection_(connection),
      changes_before_(sqlite3_total_changes64(connection.database_.get())) {
  // A writer locks at once, because a reader could not wait for the lock later.
  open_ = !run(access == Access::kWrite ? "BEGIN IMMEDIATE" : "BEGIN").next() && !failed();
}

Transaction::~Transaction() {
  // Some errors have rolled it back already.
  if (open_ && sqlite3_get_autocommit(connection_.database_.get()) == 0) {
    sqlite3_exec(connection_.database_.get(), "ROLLBACK", nullptr, nullptr, nullptr);
  }
}

StoreResult<void> Transaction::commit() {
  run("COMMIT").next();
  if (error_) return tl::unexpected(*error_);
  open_ = false;
  return {};
}

void Transaction::fail(StoreError error) {
  if (!error_) error_ = std::move(error);
}

std::int64_t Transaction::changes() const {
  return sqlite3_total_changes64(connection_.database_.get()) - changes_before_;
}

std::string Transaction::blob(const char* table, const char* column, std::int64_t row) {
  std::string bytes;
  if (error_) return bytes;
  sqlite3_blob* handle = nullptr;
  if (check(
          sqlite3_blob_open(connection_.database_.get(), "main", table, column, row, 0, &handle))) {
    bytes.resize(static_cast<std::size_t>(sqlite3_blob_bytes(handle)));
    check(sqlite3_blob_read(handle, bytes.data(), static_cast<int>(bytes.size()), 0));
  }
  sqlite3_blob_close(handle);
  return bytes;
}

int Transaction::bind(sqlite3_stmt* statement, int parameter, std::int64_t value) {
  return sqlite3_bind_int64(statement, parameter, value);
}

int Transaction::bind(sqlite3_stmt* statement, int parameter, std::string_view text) {
  return sqlite3_bind_text64(statement, parameter, text.data() == nullptr ? "" : text.data(),
                             text.size(), SQLITE_STATIC, SQLITE_UTF8);
}

int Transaction::bind(sqlite3_stmt* statement, int parameter, Blob blob) {
  return sqlite3_bind_blob64(statement, parameter,
                             blob.bytes.data() == nullptr ? "" : blob.bytes.data(),
                             blob.bytes.size(), SQLITE_STATIC);
}

int Transaction::bind(sqlite3_stmt* statement, int parameter, std::nullptr_t) {
  return sqlite3_bind_null(statement, parameter);
}

sqlite3_stmt* Transaction::prepare(std::string_view sql) {
  sqlite3_stmt* const statement = connection_.statement(sql);
  if (statement == nullptr) check(sqlite3_extended_errcode(connection_.database_.get()));
  return statement;
}

bool Transaction::check(int code) {
  if (code == SQLITE_OK) return true;
  fail(connection_.error(code));
  return false;
}

}  // namespace weft::server::sqlite

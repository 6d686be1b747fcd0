// SPDX-License-Identifier: Apache-2.0
#include "server/store/postgres/postgres.h"

#include <poll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <utility>
#include <vector>

namespace weft::server::postgres {
namespace {

// The numbers of the types in pg_type.
constexpr Oid kBool = 16;
constexpr Oid kBytea = 17;
constexpr Oid kBigint = 20;
constexpr Oid kText = 25;

constexpr std::string_view kDeadlock = "40P01";
constexpr std::string_view kSerializationFailure = "40001";

// libpq ends its messages with a line feed, and may write several lines.
std::string one_line(const char* message) {
  std::string line = message == nullptr ? "" : message;
  while (!line.empty() && line.back() == '\n') line.pop_back();
  std::replace(line.begin(), line.end(), '\n', ' ');
  return "PostgreSQL: " + line;
}

StoreErrorKind kind_of(std::string_view state) {
  if (state == "53100") return StoreErrorKind::kFull;
  const std::string_view group = state.substr(0, 2);
  // The data are damaged, or the tables are not the ones that the statement expects.
  if (group == "XX" || group == "42") return StoreErrorKind::kBroken;
  return StoreErrorKind::kUnavailable;
}

}  // namespace

Value::Value(std::int64_t number) : type_(kBigint), size_(8) {
  for (int i = 0; i < 8; ++i) number_[i] = static_cast<char>(number >> (56 - 8 * i));
}

Value::Value(bool truth) : type_(kBool), size_(1) {
  number_[0] = truth ? 1 : 0;
}

Value::Value(std::string_view text)
    : type_(kText), bytes_(text), size_(static_cast<int>(text.size())) {}

Value::Value(Blob blob)
    : type_(kBytea), bytes_(blob.bytes), size_(static_cast<int>(blob.bytes.size())) {}

Value Value::null_like(Value value) {
  value.null_ = true;
  return value;
}

StoreResult<std::unique_ptr<Connection>> Connection::open(const Options& options) {
  if (auto loaded = load_libpq(); !loaded) return tl::unexpected(loaded.error());
  const std::string timeout = std::to_string(options.connect_timeout.count());
  // Notices within half a minute that the server has vanished, even if nothing is sent.
  const std::array keywords{"dbname",
                            "connect_timeout",
                            "application_name",
                            "keepalives_idle",
                            "keepalives_interval",
                            "keepalives_count",
                            "tcp_user_timeout",
                            static_cast<const char*>(nullptr)};
  const std::array values{options.uri.c_str(),
                          timeout.c_str(),
                          "weftd",
                          "10",
                          "5",
                          "4",
                          "30000",
                          static_cast<const char*>(nullptr)};
  PGconn* const raw = libpq().PQconnectdbParams(keywords.data(), values.data(), 1);
  std::unique_ptr<Connection> connection(new Connection(raw, options.statement_timeout));
  if (libpq().PQstatus(raw) != CONNECTION_OK) {
    return tl::unexpected(
        StoreError{StoreErrorKind::kUnavailable, one_line(libpq().PQerrorMessage(raw))});
  }
  libpq().PQsetnonblocking(raw, 1);
  // libpq would print the server's notices to stderr.
  libpq().PQsetNoticeProcessor(
      raw, [](void*, const char*) {}, nullptr);
  // A server that stops in the middle of a transaction must not hold its locks for ever.
  const std::string ms = std::to_string(options.statement_timeout.count());
  const std::string settings = "SET statement_timeout = " + ms +
                               ";SET idle_in_transaction_session_timeout = " + ms +
                               ";SET client_min_messages = warning"
                               ";SET default_transaction_isolation = 'read committed'";
  if (const auto set = connection->execute(settings.c_str()); !set) {
    return tl::unexpected(set.error());
  }
  return connection;
}

StoreError Connection::error(const PGresult* result) {
  const char* const state =
      result == nullptr ? nullptr : libpq().PQresultErrorField(result, PG_DIAG_SQLSTATE);
  if (state == nullptr) {
    return {StoreErrorKind::kUnavailable, one_line(libpq().PQerrorMessage(connection_.get()))};
  }
  state_ = state;
  return {kind_of(state), one_line(libpq().PQresultErrorMessage(result)) + " (" + state + ")"};
}

StoreResult<void> Connection::execute(const char* sql) {
  const auto result = answer(libpq().PQsendQuery(connection_.get(), sql) == 1, patience_);
  if (!result) return tl::unexpected(result.error());
  return {};
}

StoreResult<void> Connection::execute_patiently(const char* sql) {
  const std::string patiently = std::string("SET LOCAL statement_timeout = 0;") + sql;
  const auto result =
      answer(libpq().PQsendQuery(connection_.get(), patiently.c_str()) == 1, std::chrono::hours(1));
  if (!result) return tl::unexpected(result.error());
  return {};
}

StoreResult<Result> Connection::run(const char* sql, std::initializer_list<Value> values) {
  std::vector<Oid> types;
  std::vector<const char*> bytes;
  std::vector<int> sizes;
  std::vector<int> binary(values.size(), 1);
  for (const Value& value : values) {
    const bool copied = value.type_ == kBigint || value.type_ == kBool;
    // An empty view may be a null pointer, which libpq would take for NULL.
    const char* const there = value.bytes_.data() == nullptr ? "" : value.bytes_.data();
    types.push_back(value.type_);
    bytes.push_back(value.null_ ? nullptr : copied ? value.number_ : there);
    sizes.push_back(value.size_);
  }
  const int sent =
      libpq().PQsendQueryParams(connection_.get(), sql, static_cast<int>(values.size()),
                                types.data(), bytes.data(), sizes.data(), binary.data(), 1);
  return answer(sent == 1, patience_);
}

// The last result, or the first that is an error.
StoreResult<Result> Connection::answer(bool sent, std::chrono::milliseconds patience) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end = Clock::now() + patience;
  const auto give_up = [this](std::string message) {
    broken_ = true;
    return tl::unexpected(StoreError{StoreErrorKind::kUnavailable, std::move(message)});
  };
  state_.clear();
  if (!sent) return give_up(one_line(libpq().PQerrorMessage(connection_.get())));
  Result last;
  while (true) {
    const int unsent = libpq().PQflush(connection_.get());
    if (unsent < 0) return give_up(one_line(libpq().PQerrorMessage(connection_.get())));
    if (unsent == 0 && libpq().PQisBusy(connection_.get()) == 0) {
      Result next(libpq().PQgetResult(connection_.get()));
      if (!next) break;
      const bool was_error = last && libpq().PQresultStatus(last.get()) == PGRES_FATAL_ERROR;
      if (!was_error) last = std::move(next);
      if (libpq().PQstatus(connection_.get()) != CONNECTION_OK) break;
      continue;
    }
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
    if (left.count() <= 0) return give_up("PostgreSQL: the server does not answer");
    pollfd wait{socket(), static_cast<short>(POLLIN | (unsent == 1 ? POLLOUT : 0)), 0};
    const int ready = poll(&wait, 1, static_cast<int>(left.count()));
    if (ready < 0 && errno != EINTR) return give_up(std::strerror(errno));
    if (ready > 0 && (wait.revents & ~POLLOUT) != 0 &&
        libpq().PQconsumeInput(connection_.get()) == 0) {
      return give_up(one_line(libpq().PQerrorMessage(connection_.get())));
    }
  }
  const ExecStatusType status = libpq().PQresultStatus(last.get());
  if (status != PGRES_COMMAND_OK && status != PGRES_TUPLES_OK) {
    return tl::unexpected(error(last.get()));
  }
  return last;
}

std::optional<std::string> Connection::next_notification() {
  if (libpq().PQconsumeInput(connection_.get()) == 0) broken_ = true;
  PGnotify* const notification = libpq().PQnotifies(connection_.get());
  if (notification == nullptr) return std::nullopt;
  std::string payload = notification->extra;
  libpq().PQfreemem(notification);
  return payload;
}

bool Rows::next() {
  return result_ && ++row_ < libpq().PQntuples(result_.get());
}

bool Rows::null(int column) const {
  return libpq().PQgetisnull(result_.get(), row_, column) == 1;
}

std::int64_t Rows::integer(int column) const {
  const auto* const bytes =
      reinterpret_cast<const unsigned char*>(libpq().PQgetvalue(result_.get(), row_, column));
  std::uint64_t number = 0;
  for (int i = 0; i < libpq().PQgetlength(result_.get(), row_, column); ++i)
    number = number << 8 | bytes[i];
  return static_cast<std::int64_t>(number);
}

std::string Rows::bytes(int column) const {
  return {libpq().PQgetvalue(result_.get(), row_, column),
          static_cast<std::size_t>(libpq().PQgetlength(result_.get(), row_, column))};
}

Transaction::Transaction(Connection& connection, Begin begin)
    : connection_(connection), begin_(begin) {
  if (begin == Begin::kOneStatement) return;
  const auto begun = connection_.execute(
      begin == Begin::kLater ? "BEGIN;SET LOCAL synchronous_commit = off" : "BEGIN");
  if (begun) {
    open_ = true;
  } else {
    error_ = begun.error();
  }
}

Transaction::~Transaction() {
  if (open_ && !connection_.broken()) (void)connection_.execute("ROLLBACK");
}

Result Transaction::take(const char* sql, std::initializer_list<Value> values) {
  if (error_) return nullptr;
  StoreResult<Result> result = connection_.run(sql, values);
  if (result) return std::move(*result);
  ambiguous_ = begin_ == Begin::kOneStatement && connection_.broken();
  collided_ = connection_.state_ == kDeadlock || connection_.state_ == kSerializationFailure;
  fail(result.error());
  return nullptr;
}

std::int64_t Transaction::count(const Result& result) {
  if (!result) return 0;
  const std::string_view digits = libpq().PQcmdTuples(result.get());
  std::int64_t rows = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), rows);
  return rows;
}

void Transaction::notify(std::string_view channel, std::string_view payload) {
  notification_ = "NOTIFY " + std::string(channel) + ", '" + std::string(payload) + "';";
}

void Transaction::fail(StoreError error) {
  if (!error_) error_ = std::move(error);
}

StoreResult<void> Transaction::commit() {
  if (!error_ && open_) {
    const auto done = connection_.execute((notification_ + "COMMIT").c_str());
    if (done) {
      open_ = false;
    } else {
      ambiguous_ = connection_.broken();
      fail(done.error());
    }
  }
  if (error_) return tl::unexpected(*error_);
  return {};
}

}  // namespace weft::server::postgres

// SPDX-License-Identifier: Apache-2.0
// The base of every function of the SQLite store: the folder, the connections and their locks, the
// clock, and notifications of changes.
//
// Thread-safety: every function may be called from any thread.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "server/store/sqlite/sqlite.h"
#include "server/store/sqlite/sqlite_store.h"

namespace weft::server {

// Whether a commit waits for the disk. One that does also writes all earlier commits.
enum class Durability { kWait, kLater };

// Closes a descriptor.
class FileHandle {
 public:
  explicit FileHandle(int descriptor) : descriptor_(descriptor) {}
  ~FileHandle();
  FileHandle(FileHandle&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  FileHandle& operator=(FileHandle&&) = delete;
  int get() const { return descriptor_; }

 private:
  int descriptor_;
};

class SqliteCore {
 public:
  static StoreResult<std::unique_ptr<SqliteCore>> open(SqliteStore::Options options);

  WallTime now() const { return clock_(); }

  // Runs `body(transaction)` and commits; its result is valid only then. `write` calls the listener
  // if anything has changed, `write_quietly` does not.
  template <class Body>
  auto write(Durability durability, const Body& body) {
    bool changed = false;
    auto result = locked_write(durability, body, changed);
    if (changed && listener_) listener_();
    return result;
  }
  template <class Body>
  auto write_quietly(Durability durability, const Body& body) {
    bool changed = false;
    return locked_write(durability, body, changed);
  }
  // Returns what `write()` does, which deletes: on a full disk, it may use the space that is kept.
  template <class Write>
  auto with_reserve(const Write& write) {
    auto result = write();
    if (result || result.error().kind != StoreErrorKind::kFull) return result;
    release_reserve();
    return write();
  }
  template <class Body>
  auto read(const Body& body) {
    Reader reader(*this);
    return in_transaction(*reader.connection, sqlite::Access::kRead, body);
  }

  // Gives free pages back to the file system, in steps between which others may write. Keeps space
  // for later deletions if there is some.
  StoreResult<void> give_space_back();

  void on_change(std::function<void()> listener) { listener_ = std::move(listener); }

 private:
  // Lends a connection to read with while it lives.
  struct Reader {
    explicit Reader(SqliteCore& from);
    ~Reader();
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    SqliteCore& core;
    std::unique_ptr<sqlite::Connection> connection;
  };

  SqliteCore(FileHandle lock, FileHandle reserve, std::function<WallTime()> clock)
      : lock_(std::move(lock)), reserve_(std::move(reserve)), clock_(std::move(clock)) {}

  template <class Body>
  static auto in_transaction(sqlite::Connection& connection, sqlite::Access access,
                             const Body& body) {
    sqlite::Transaction transaction(connection, access);
    using Value = decltype(body(transaction));
    Value value = body(transaction);
    const StoreResult<void> done = transaction.commit();
    if (!done) return StoreResult<Value>(tl::unexpected(done.error()));
    return StoreResult<Value>(std::move(value));
  }

  template <class Body>
  auto locked_write(Durability durability, const Body& body, bool& changed) {
    const std::lock_guard lock(writing_);
    if (const auto set = wait_for_disk(durability == Durability::kWait); !set) {
      return decltype(in_transaction(*writer_, sqlite::Access::kWrite, body))(
          tl::unexpected(set.error()));
    }
    auto result =
        in_transaction(*writer_, sqlite::Access::kWrite, [&](sqlite::Transaction& transaction) {
          auto value = body(transaction);
          changed = transaction.changes() != 0;
          return value;
        });
    changed = changed && result.has_value();
    return result;
  }

  static StoreResult<std::unique_ptr<SqliteCore>> open_locked(FileHandle lock,
                                                              const std::string& path,
                                                              SqliteStore::Options options);
  StoreResult<void> wait_for_disk(bool wait);
  void keep_reserve();
  void release_reserve();
  StoreResult<void> vacuum(std::int64_t pages);
  StoreResult<void> empty_log();

  const FileHandle lock_;     // keeps other servers out; destroyed last
  const FileHandle reserve_;  // a file that takes space until a deletion needs it
  const std::function<WallTime()> clock_;
  std::function<void()> listener_;

  std::mutex writing_;  // guards the two below
  std::unique_ptr<sqlite::Connection> writer_;
  bool waits_for_disk_ = true;

  std::mutex reading_;  // guards the one below
  std::condition_variable reader_returned_;
  std::vector<std::unique_ptr<sqlite::Connection>> idle_readers_;
};

}  // namespace weft::server

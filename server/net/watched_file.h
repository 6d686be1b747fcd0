// SPDX-License-Identifier: Apache-2.0
// A table in a file, read again once per second. While the file is missing, empty or wrong, the
// table stays as it was, and the log says so once. It warns of a file that others may read or
// write.
//
//   auto file = WatchedFile<TokenTable>::open("/etc/weft/tokens", log);
//   if (!file) return complain(file.error());
//   if (auto name = (*file)->table()->name_of(token)) ...
//
// Thread-safe.
#pragma once

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <tl/expected.hpp>
#include <utility>

#include "server/observe/log.h"

namespace weft::server {

// Of the first MiB of a file, or of why it cannot be read: differs if the file has changed,
// whatever its time stamp says.
std::string digest_of(const std::filesystem::path& path);

// What is the same for all tables.
class FileWatcher {
 public:
  // Takes the contents, and returns the number of rows, or what is wrong; called by `open`, and
  // then on another thread.
  using Take = std::function<tl::expected<std::size_t, std::string>(std::string_view contents)>;

  // `holds`: what the rows are, such as "tokens".
  static tl::expected<std::unique_ptr<FileWatcher>, std::string> open(
      const std::filesystem::path& path, const char* holds, Take take, Logger log,
      std::chrono::milliseconds between_looks);
  ~FileWatcher();
  FileWatcher(const FileWatcher&) = delete;
  FileWatcher& operator=(const FileWatcher&) = delete;

  void reload();
  void on_change(std::function<void()> listener);

 private:
  FileWatcher(std::filesystem::path path, const char* holds, Take take, Logger log,
              std::chrono::milliseconds between_looks);
  // Returns the number of rows, or 0 if the file has not changed.
  tl::expected<std::size_t, std::string> read();
  void warn_if_exposed();
  void look();
  void look_until_stopped();

  const std::filesystem::path path_;
  const char* const holds_;
  const Take take_;
  const Logger log_;
  const std::chrono::milliseconds between_looks_;
  std::string last_seen_;      // digest of the file's contents; used only by the watching thread
  unsigned seen_mode_ = 0600;  // the file's; the same

  std::mutex mutex_;  // guards the two below
  bool stopping_ = false;
  bool look_now_ = false;
  std::condition_variable changed_;
  std::mutex calling_;  // guards the one below
  std::function<void()> listener_;
  std::thread watcher_;
};

// `Table::parse` makes one of the contents, with a row at least; `Table::kHolds` says what rows
// are.
template <class Table>
class WatchedFile {
 public:
  static tl::expected<std::unique_ptr<WatchedFile>, std::string> open(
      const std::filesystem::path& path, Logger log,
      std::chrono::milliseconds between_looks = std::chrono::seconds(1)) {
    std::unique_ptr<WatchedFile> file(new WatchedFile());
    auto watcher = FileWatcher::open(
        path, Table::kHolds,
        [self = file.get()](std::string_view text) { return self->take(text); }, std::move(log),
        between_looks);
    if (!watcher) return tl::unexpected(watcher.error());
    file->watcher_ = std::move(*watcher);
    return file;
  }

  std::shared_ptr<const Table> table() const {
    std::lock_guard lock(mutex_);
    return table_;
  }

  // Reads the file now, on another thread.
  void reload() { watcher_->reload(); }

  // `listener` is called, on another thread, after there is another table. Once this returns, no
  // call of an earlier listener is at work.
  void on_change(std::function<void()> listener) { watcher_->on_change(std::move(listener)); }

 private:
  WatchedFile() = default;
  tl::expected<std::size_t, std::string> take(std::string_view text) {
    auto table = Table::parse(text);
    if (!table) return tl::unexpected(table.error());
    const auto fresh = std::make_shared<const Table>(std::move(*table));
    std::lock_guard lock(mutex_);
    table_ = fresh;
    return fresh->size();
  }

  mutable std::mutex mutex_;  // guards the one below
  std::shared_ptr<const Table> table_;
  std::unique_ptr<FileWatcher> watcher_;  // destroyed first: its thread uses the above
};

}  // namespace weft::server

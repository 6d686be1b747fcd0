// SPDX-License-Identifier: Apache-2.0
// Bearer tokens and their names, from a file of lines `NAME TOKEN`. Empty lines and lines that
// begin with # are ignored; a name may have several tokens, so that one can replace another.
//
//   # /etc/weft/tokens
//   ann 3f9c0e...
//   ci  b81d77...
//
// Only digests of tokens are kept, and all of them are compared in constant time, so the time of a
// reply does not reveal how much of a token was right.
//
//   auto file = TokenFile::open("/etc/weft/tokens", log);
//   if (!file) return complain(file.error());
//   if (auto name = (*file)->table()->name_of(token)) ...
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <tl/expected.hpp>
#include <vector>

#include "server/observe/log.h"

namespace weft::server {

class TokenTable {
 public:
  // The error names the line, and never repeats a token. A table without tokens is an error.
  static tl::expected<TokenTable, std::string> parse(std::string_view text);

  std::optional<std::string> name_of(std::string_view token) const;
  // The same of a token of which only the digest is known.
  std::optional<std::string> name_of_digest(std::string_view digest) const;
  static std::string digest_of(std::string_view token);  // 32 bytes
  std::size_t size() const { return entries_.size(); }

 private:
  struct Entry {
    std::string name;
    std::array<unsigned char, 32> digest;
  };
  std::vector<Entry> entries_;
};

// The table in a file, read again once per second. While the file is missing, empty or wrong, the
// table stays as it was, and the log says so once. It warns of a file that others may read or
// write. Thread-safe.
class TokenFile {
 public:
  static tl::expected<std::unique_ptr<TokenFile>, std::string> open(
      const std::filesystem::path& path, Logger log,
      std::chrono::milliseconds between_looks = std::chrono::seconds(1));
  ~TokenFile();
  TokenFile(const TokenFile&) = delete;
  TokenFile& operator=(const TokenFile&) = delete;

  std::shared_ptr<const TokenTable> table() const;

  // Reads the file now, on another thread.
  void reload();

  // `listener` is called, on another thread, after there is another table. Once this returns, no
  // call of an earlier listener is at work.
  void on_change(std::function<void()> listener);

 private:
  TokenFile(std::filesystem::path path, Logger log, std::chrono::milliseconds between_looks);
  // Returns nullopt if the file has not changed.
  tl::expected<std::optional<TokenTable>, std::string> read();
  void warn_if_exposed();
  void look();
  void look_until_stopped();

  const std::filesystem::path path_;
  const Logger log_;
  const std::chrono::milliseconds between_looks_;
  std::string last_seen_;      // digest of the file's contents; used only by the watching thread
  unsigned seen_mode_ = 0600;  // the file's; the same

  mutable std::mutex mutex_;  // guards the three below
  std::shared_ptr<const TokenTable> table_;
  bool stopping_ = false;
  bool look_now_ = false;
  std::condition_variable changed_;
  std::mutex calling_;  // guards the one below
  std::function<void()> listener_;
  std::thread watcher_;
};

}  // namespace weft::server

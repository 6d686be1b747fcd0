// SPDX-License-Identifier: Apache-2.0
#include "server/net/tokens.h"

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/sha.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

namespace weft::server {
namespace {

constexpr std::size_t kLargestFile = std::size_t{1} << 20;
constexpr std::size_t kLongestName = 128;
// Of 64 characters, 16 have 96 bits.
constexpr std::size_t kShortestToken = 16;

// Of the file's mode: others may read it or write it, or the group may write it.
constexpr unsigned kExposed = 0026;

using Digest = std::array<unsigned char, SHA256_DIGEST_LENGTH>;

Digest sha256_of(std::string_view text) {
  Digest digest;
  SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(), digest.data());
  return digest;
}

// Takes the first word out of the line.
std::string_view next_word(std::string_view& line) {
  constexpr std::string_view kSpace = " \t\r\v\f";
  line.remove_prefix(std::min(line.find_first_not_of(kSpace), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kSpace));
  line.remove_prefix(word.size());
  return word;
}

bool visible_ascii(std::string_view word) {
  return std::all_of(word.begin(), word.end(), [](char c) { return c > ' ' && c < 0x7f; });
}

tl::expected<std::string, std::string> contents_of(const std::filesystem::path& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(path.c_str(), "re"),
                                                           &std::fclose);
  if (in == nullptr) return tl::unexpected(std::string(std::strerror(errno)));
  std::string text(kLargestFile + 1, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), in.get()));
  if (std::ferror(in.get()) != 0) return tl::unexpected(std::string(std::strerror(errno)));
  if (text.size() > kLargestFile)
    return tl::unexpected(fmt::format("it has more than {} bytes", kLargestFile));
  return text;
}

}  // namespace

tl::expected<TokenTable, std::string> TokenTable::parse(std::string_view text) {
  TokenTable table;
  for (std::size_t number = 1; !text.empty(); ++number) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    const std::string_view name = next_word(line);
    if (name.empty() || name.front() == '#') continue;
    const std::string_view token = next_word(line);
    const auto bad = [number](const std::string& reason) {
      return tl::unexpected(fmt::format("line {}: {}", number, reason));
    };
    if (token.empty() || !next_word(line).empty()) return bad("not of the form NAME TOKEN");
    if (!visible_ascii(name) || name.size() > kLongestName)
      return bad("a name is up to 128 visible ASCII characters");
    if (!visible_ascii(token)) return bad("a token is visible ASCII characters");
    if (token.size() < kShortestToken)
      return bad(fmt::format("the token has {} characters; the least is {}", token.size(),
                             kShortestToken));
    if (table.name_of(token)) return bad("the token is used twice");
    table.entries_.push_back({std::string(name), sha256_of(token)});
  }
  if (table.entries_.empty()) return tl::unexpected(std::string("it holds no token"));
  return table;
}

std::optional<std::string> TokenTable::name_of(std::string_view token) const {
  return name_of_digest(digest_of(token));
}

std::string TokenTable::digest_of(std::string_view token) {
  const Digest digest = sha256_of(token);
  return {digest.begin(), digest.end()};
}

std::optional<std::string> TokenTable::name_of_digest(std::string_view digest) const {
  const Entry* found = nullptr;
  for (const Entry& entry : entries_)
    if (digest.size() == entry.digest.size() &&
        CRYPTO_memcmp(entry.digest.data(), digest.data(), digest.size()) == 0)
      found = &entry;
  if (found == nullptr) return std::nullopt;
  return found->name;
}

tl::expected<std::unique_ptr<TokenFile>, std::string> TokenFile::open(
    const std::filesystem::path& path, Logger log, std::chrono::milliseconds between_looks) {
  std::unique_ptr<TokenFile> file(new TokenFile(path, std::move(log), between_looks));
  auto table = file->read();
  if (!table)
    return tl::unexpected(fmt::format("the tokens in {}: {}", path.string(), table.error()));
  file->table_ = std::make_shared<const TokenTable>(std::move(**table));
  file->warn_if_exposed();
  file->watcher_ = std::thread([self = file.get()] { self->look_until_stopped(); });
  return file;
}

TokenFile::TokenFile(std::filesystem::path path, Logger log,
                     std::chrono::milliseconds between_looks)
    : path_(std::move(path)), log_(std::move(log)), between_looks_(between_looks) {}

TokenFile::~TokenFile() {
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (watcher_.joinable()) watcher_.join();
}

std::shared_ptr<const TokenTable> TokenFile::table() const {
  std::lock_guard lock(mutex_);
  return table_;
}

void TokenFile::reload() {
  {
    std::lock_guard lock(mutex_);
    look_now_ = true;
  }
  changed_.notify_all();
}

void TokenFile::on_change(std::function<void()> listener) {
  std::lock_guard lock(calling_);
  listener_ = std::move(listener);
}

// Reads the whole file every time: it is small, and its time stamp may stay the same when it
// changes.
tl::expected<std::optional<TokenTable>, std::string> TokenFile::read() {
  const auto text = contents_of(path_);
  const Digest digest = sha256_of(text ? *text : text.error());
  std::string seen(digest.begin(), digest.end());
  if (seen == last_seen_) return std::nullopt;
  last_seen_ = std::move(seen);
  if (!text) return tl::unexpected(text.error());
  auto table = TokenTable::parse(*text);
  if (!table) return tl::unexpected(table.error());
  return std::move(*table);
}

void TokenFile::warn_if_exposed() {
  struct stat file {};
  if (::stat(path_.c_str(), &file) != 0) return;
  const unsigned mode = file.st_mode & 0777;
  if ((mode & kExposed) != 0 && mode != seen_mode_)
    log_->warn("event=tokens_exposed path={} mode={:04o} message={}", log_value(path_.string()),
               mode, log_value("other users of this machine may read or write the tokens"));
  seen_mode_ = mode;
}

void TokenFile::look() {
  warn_if_exposed();
  auto table = read();
  if (!table) {
    log_->warn("event=tokens_kept path={} message={}", log_value(path_.string()),
               log_value(table.error()));
    return;
  }
  if (!*table) return;
  const auto fresh = std::make_shared<const TokenTable>(std::move(**table));
  {
    std::lock_guard lock(mutex_);
    table_ = fresh;
  }
  log_->info("event=tokens_read path={} tokens={}", log_value(path_.string()), fresh->size());
  std::lock_guard lock(calling_);
  if (listener_) listener_();
}

void TokenFile::look_until_stopped() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait_for(lock, between_looks_, [this] { return stopping_ || look_now_; });
    if (stopping_) return;
    look_now_ = false;
    lock.unlock();
    look();
    lock.lock();
  }
}

}  // namespace weft::server

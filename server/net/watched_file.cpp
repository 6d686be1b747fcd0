// SPDX-License-Identifier: Apache-2.0
#include "server/net/watched_file.h"

#include <fmt/format.h>
#include <openssl/sha.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace weft::server {
namespace {

constexpr std::size_t kLargestFile = std::size_t{1} << 20;

// Of the file's mode: others may read it or write it, or the group may write it.
constexpr unsigned kExposed = 0026;

std::string sha256_of(std::string_view text) {
  std::string digest(SHA256_DIGEST_LENGTH, '\0');
  SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(),
         reinterpret_cast<unsigned char*>(digest.data()));
  return digest;
}

// The first kLargestFile + 1 bytes at most.
tl::expected<std::string, std::string> contents_of(const std::filesystem::path& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(path.c_str(), "re"),
                                                           &std::fclose);
  if (in == nullptr) return tl::unexpected(std::string(std::strerror(errno)));
  std::string text(kLargestFile + 1, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), in.get()));
  if (std::ferror(in.get()) != 0) return tl::unexpected(std::string(std::strerror(errno)));
  return text;
}

std::string digest_of_contents(const tl::expected<std::string, std::string>& contents) {
  return sha256_of(contents ? *contents : contents.error());
}

}  // namespace

std::string digest_of(const std::filesystem::path& path) {
  return digest_of_contents(contents_of(path));
}

tl::expected<std::unique_ptr<FileWatcher>, std::string> FileWatcher::open(
    const std::filesystem::path& path, const char* holds, Take take, Logger log,
    std::chrono::milliseconds between_looks) {
  std::unique_ptr<FileWatcher> file(
      new FileWatcher(path, holds, std::move(take), std::move(log), between_looks));
  if (const auto rows = file->read(); !rows)
    return tl::unexpected(fmt::format("the {} in {}: {}", holds, path.string(), rows.error()));
  file->warn_if_exposed();
  file->watcher_ = std::thread([self = file.get()] { self->look_until_stopped(); });
  return file;
}

FileWatcher::FileWatcher(std::filesystem::path path, const char* holds, Take take, Logger log,
                         std::chrono::milliseconds between_looks)
    : path_(std::move(path)),
      holds_(holds),
      take_(std::move(take)),
      log_(std::move(log)),
      between_looks_(between_looks) {}

FileWatcher::~FileWatcher() {
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (watcher_.joinable()) watcher_.join();
}

void FileWatcher::reload() {
  {
    std::lock_guard lock(mutex_);
    look_now_ = true;
  }
  changed_.notify_all();
}

void FileWatcher::on_change(std::function<void()> listener) {
  std::lock_guard lock(calling_);
  listener_ = std::move(listener);
}

// Reads the whole file every time: it is small, and its time stamp may stay the same when it
// changes.
tl::expected<std::size_t, std::string> FileWatcher::read() {
  const auto text = contents_of(path_);
  std::string seen = digest_of_contents(text);
  if (seen == last_seen_) return 0;
  last_seen_ = std::move(seen);
  if (!text) return tl::unexpected(text.error());
  if (text->size() > kLargestFile)
    return tl::unexpected(fmt::format("it has more than {} bytes", kLargestFile));
  return take_(*text);
}

void FileWatcher::warn_if_exposed() {
  struct stat file {};
  if (::stat(path_.c_str(), &file) != 0) return;
  const unsigned mode = file.st_mode & 0777;
  if ((mode & kExposed) != 0 && mode != seen_mode_)
    log_->warn(
        "event={}_exposed path={} mode={:04o} message={}", holds_, log_value(path_.string()), mode,
        log_value(fmt::format("other users of this machine may read or write the {}", holds_)));
  seen_mode_ = mode;
}

void FileWatcher::look() {
  warn_if_exposed();
  const auto rows = read();
  if (!rows) {
    log_->warn("event={}_kept path={} message={}", holds_, log_value(path_.string()),
               log_value(rows.error()));
    return;
  }
  if (*rows == 0) return;
  log_->info("event={}_read path={} {}={}", holds_, log_value(path_.string()), holds_, *rows);
  std::lock_guard lock(calling_);
  if (listener_) listener_();
}

void FileWatcher::look_until_stopped() {
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

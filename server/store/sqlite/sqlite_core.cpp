// SPDX-License-Identifier: Apache-2.0
#include "server/store/sqlite/sqlite_core.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "server/store/sqlite/sqlite_schema.h"

namespace weft::server {
namespace {

// The page size and the vacuum apply to a new file, the others to the connection. The log is cut
// back to what a checkpoint usually leaves. Foreign keys keep a chunk that a mesh refers to.
constexpr const char* kWriterSettings = R"sql(
PRAGMA page_size = 16384;
PRAGMA auto_vacuum = INCREMENTAL;
PRAGMA journal_mode = WAL;
PRAGMA synchronous = FULL;
PRAGMA wal_autocheckpoint = 1024;
PRAGMA journal_size_limit = 67108864;
PRAGMA foreign_keys = ON;
)sql";

constexpr std::int64_t kVacuumStep = 512;  // pages: 8 MiB, some tens of milliseconds
// On a full disk, and what is kept free for deletions: a step, and what it takes to delete some
// chunks.
constexpr std::int64_t kSmallVacuumStep = 64;
constexpr off_t kReserve = off_t{4} << 20;

StoreError failed_at(const std::string& path) {
  const int error = errno;
  return {error == ENOSPC || error == EDQUOT ? StoreErrorKind::kFull : StoreErrorKind::kUnavailable,
          path + ": " + std::strerror(error)};
}

StoreResult<void> make_folder(const std::string& folder) {
  const std::filesystem::path parent = std::filesystem::absolute(folder).parent_path();
  std::error_code error;
  std::filesystem::create_directories(parent, error);
  if (mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST) {
    return tl::unexpected(failed_at(folder));
  }
  return {};
}

StoreResult<FileHandle> lock_folder(const std::string& folder) {
  const std::string path = folder + "/weft.lock";
  FileHandle file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  if (file.get() < 0) return tl::unexpected(failed_at(path));
  if (flock(file.get(), LOCK_EX | LOCK_NB) == 0) return file;
  if (errno != EWOULDBLOCK) return tl::unexpected(failed_at(path));
  return tl::unexpected(
      StoreError{StoreErrorKind::kUnavailable, folder + " is in use by another weftd"});
}

// A store that was cut off must not begin anew as if nothing had been in it. kBroken if the file is
// empty though a server had the folder before.
StoreResult<void> check_not_emptied(const std::string& folder, const std::string& path) {
  std::error_code error;
  const bool is_empty = std::filesystem::file_size(path, error) == 0 && !error;
  if (!is_empty || !std::filesystem::exists(folder + "/weft.lock", error)) return {};
  return tl::unexpected(StoreError{
      StoreErrorKind::kBroken,
      path + " has 0 bytes, but a server has had " + folder +
          " before: restore the file, or remove it if the store may begin anew without its jobs"});
}

// SQLite gives a new file the permissions of the umask, and the files beside it those of the first.
StoreResult<void> make_private(const std::string& path) {
  const FileHandle file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  if (file.get() < 0) return tl::unexpected(failed_at(path));
  return {};
}

}  // namespace

FileHandle::~FileHandle() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

StoreResult<std::unique_ptr<SqliteCore>> SqliteCore::open(SqliteStore::Options options) {
  const std::string path = options.folder + "/weft.db";
  if (const auto made = make_folder(options.folder); !made) return tl::unexpected(made.error());
  const auto sound = check_not_emptied(options.folder, path);
  StoreResult<FileHandle> lock = lock_folder(options.folder);
  if (!lock) return tl::unexpected(lock.error());
  if (!sound) return tl::unexpected(sound.error());

  std::error_code error;
  const bool is_new = !std::filesystem::exists(path, error);
  auto core = open_locked(std::move(*lock), path, std::move(options));
  if (!core && is_new) std::filesystem::remove(path, error);  // as empty as it was made
  return core;
}

StoreResult<std::unique_ptr<SqliteCore>> SqliteCore::open_locked(FileHandle lock,
                                                                 const std::string& path,
                                                                 SqliteStore::Options options) {
  const std::string spare = options.folder + "/weft.reserve";
  FileHandle reserve(::open(spare.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  std::unique_ptr<SqliteCore> core(
      new SqliteCore(std::move(lock), std::move(reserve), std::move(options.clock)));
  if (const auto made = make_private(path); !made) return tl::unexpected(made.error());
  auto writer = sqlite::Connection::open(path, sqlite::Access::kWrite);
  if (!writer) return tl::unexpected(writer.error());
  if (const auto set = (*writer)->execute(kWriterSettings); !set) {
    return tl::unexpected(StoreError{set.error().kind, path + ": " + set.error().message});
  }
  if (const auto done = migrate(**writer, path); !done) return tl::unexpected(done.error());
  core->writer_ = std::move(*writer);

  for (std::size_t i = 0; i < options.readers; ++i) {
    auto reader = sqlite::Connection::open(path, sqlite::Access::kRead);
    if (!reader) return tl::unexpected(reader.error());
    core->idle_readers_.push_back(std::move(*reader));
  }
  core->keep_reserve();
  return core;
}

SqliteCore::Reader::Reader(SqliteCore& from) : core(from) {
  std::unique_lock lock(core.reading_);
  core.reader_returned_.wait(lock, [&] { return !core.idle_readers_.empty(); });
  connection = std::move(core.idle_readers_.back());
  core.idle_readers_.pop_back();
}

SqliteCore::Reader::~Reader() {
  {
    const std::lock_guard lock(core.reading_);
    core.idle_readers_.push_back(std::move(connection));
  }
  core.reader_returned_.notify_one();
}

StoreResult<void> SqliteCore::wait_for_disk(bool wait) {
  if (wait == waits_for_disk_) return {};
  auto set = writer_->execute(wait ? "PRAGMA synchronous = FULL" : "PRAGMA synchronous = NORMAL");
  if (set) waits_for_disk_ = wait;
  return set;
}

// Without space there is no reserve, and no error.
void SqliteCore::keep_reserve() {
  if (posix_fallocate(reserve_.get(), 0, kReserve) != 0) release_reserve();
}

void SqliteCore::release_reserve() {
  (void)!ftruncate(reserve_.get(), 0);
  const std::lock_guard lock(writing_);
  (void)empty_log();
}

// A checkpoint shrinks the file. This one waits for readers and empties the log, which would only
// grow if there are readers at all times.
StoreResult<void> SqliteCore::empty_log() {
  return writer_->execute("PRAGMA wal_checkpoint(TRUNCATE)");
}

// Gives back so many pages at a time.
StoreResult<void> SqliteCore::vacuum(std::int64_t pages) {
  const std::string step = "PRAGMA incremental_vacuum(" + std::to_string(pages) + ")";
  while (true) {
    const std::lock_guard lock(writing_);
    const auto free_pages = writer_->pragma("PRAGMA freelist_count");
    if (!free_pages) return tl::unexpected(free_pages.error());
    if (*free_pages == 0) return {};
    if (auto done = writer_->execute(step.c_str()); !done) return done;
    if (pages < kVacuumStep)
      if (auto done = empty_log(); !done) return done;
  }
}

StoreResult<void> SqliteCore::give_space_back() {
  auto done = vacuum(kVacuumStep);
  if (!done && done.error().kind == StoreErrorKind::kFull) {
    release_reserve();
    done = vacuum(kSmallVacuumStep);
  }
  if (!done) return done;
  {
    const std::lock_guard lock(writing_);
    if (done = empty_log(); !done) return done;
  }
  keep_reserve();
  return {};
}

}  // namespace weft::server

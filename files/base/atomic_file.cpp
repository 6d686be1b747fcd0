// SPDX-License-Identifier: Apache-2.0
#include "files/base/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <random>
#include <utility>

#include "files/base/stream_copy.h"

namespace weft::files {
namespace {

constexpr int kAttempts = 100;
constexpr mode_t kMode = 0666;  // less the umask

tl::unexpected<Error> unwritable(const std::filesystem::path& target, const std::string& why) {
  return fail(ExitCode::kUnwritableOutput, target.string() + ": cannot be written: " + why);
}

std::filesystem::path folder_of(const std::filesystem::path& target) {
  const std::filesystem::path folder = target.parent_path();
  return folder.empty() ? "." : folder;
}

// The folder itself, or the nearest one above it that exists.
std::filesystem::path existing(std::filesystem::path folder) {
  std::error_code ignored;
  while (!std::filesystem::exists(folder, ignored) && !folder.empty()) {
    const std::filesystem::path parent = folder.parent_path();
    if (parent == folder) break;
    folder = parent;
  }
  return folder.empty() ? "." : folder;
}

// Succeeds if files can be made in the folder, and nothing but a file has the target's name.
Result<void> check_target_in(const std::filesystem::path& folder,
                             const std::filesystem::path& target) {
  struct stat status {};
  if (::stat(folder.c_str(), &status) != 0)
    return unwritable(target, "the folder " + folder.string() + ": " + std::strerror(errno));
  if (!S_ISDIR(status.st_mode)) return unwritable(target, folder.string() + " is not a folder");
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    return unwritable(target, "the folder " + folder.string() + ": " + std::strerror(errno));
  if (::stat(target.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
    return unwritable(target, "something other than a regular file has this name");
  return {};
}

// Folders that were not there, for files that are about to be.
class NewFolders {
 public:
  NewFolders() = default;
  NewFolders(const NewFolders&) = delete;
  NewFolders& operator=(const NewFolders&) = delete;
  ~NewFolders() {
    for (auto made = made_.rbegin(); made != made_.rend(); ++made) ::rmdir(made->c_str());
  }
  // Makes those of `target` below `folder`, which exists.
  Result<void> make(const std::filesystem::path& target, const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> missing;
    for (std::filesystem::path at = folder_of(target); at != folder && !at.empty();
         at = at.parent_path())
      missing.push_back(at);
    for (auto at = missing.rbegin(); at != missing.rend(); ++at) {
      if (::mkdir(at->c_str(), 0777) == 0)
        made_.push_back(*at);
      else if (errno != EEXIST)
        return unwritable(target, "the folder " + at->string() + ": " + std::strerror(errno));
    }
    return {};
  }
  void keep() { made_.clear(); }

 private:
  std::vector<std::filesystem::path> made_;  // removed at the end, if they are empty
};

std::filesystem::path hidden_name(const std::filesystem::path& folder) {
  std::random_device random;
  char name[32];
  std::snprintf(name, sizeof name, ".weft-%08x%08x", random(), random());
  return folder / name;
}

}  // namespace

void FileDescriptor::reset() {
  if (is_open()) ::close(fd_);
  fd_ = kClosed;
}

bool write_all(int fd, const void* bytes, std::size_t size) {
  const char* at = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t wrote = ::write(fd, at, size);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote < 0) return false;
    at += wrote;
    size -= static_cast<std::size_t>(wrote);
  }
  return true;
}

Result<FileDescriptor> open_nameless(const std::filesystem::path& folder,
                                     std::filesystem::path& name) {
  name.clear();
  FileDescriptor nameless(::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, kMode));
  if (nameless.is_open()) return nameless;
  if (errno != EOPNOTSUPP && errno != EISDIR && errno != EINVAL)
    return unwritable(folder, std::strerror(errno));
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    name = hidden_name(folder);
    FileDescriptor named(::open(name.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, kMode));
    if (named.is_open()) return named;
    if (errno != EEXIST) break;
  }
  const int problem = errno;
  name.clear();
  return unwritable(folder, std::strerror(problem));
}

Result<FileDescriptor> open_unlinked(const std::filesystem::path& folder) {
  std::filesystem::path name;
  auto file = open_nameless(folder, name);
  if (!name.empty()) ::unlink(name.c_str());
  return file;
}

Result<void> check_target(const std::filesystem::path& target) {
  return check_target_in(folder_of(target), target);
}

Result<OutputFile> OutputFile::create(const std::filesystem::path& target, std::stop_token stop,
                                      MissingFolders missing) {
  std::error_code ignored;
  if (target == kStandardOutput) {
    std::filesystem::path folder = std::filesystem::temp_directory_path(ignored);
    auto fd = open_unlinked(folder);
    if (!fd) return unwritable(target, fd.error().message);
    return OutputFile(target, std::move(folder), std::move(*fd), {}, std::move(stop));
  }
  // Writes through a link: the link stays, and its file is replaced.
  std::filesystem::path real = std::filesystem::is_symlink(target, ignored)
                                   ? std::filesystem::weakly_canonical(target, ignored)
                                   : target;
  if (real.empty()) real = target;
  std::filesystem::path folder = folder_of(real);
  if (missing == MissingFolders::kMake) folder = existing(std::move(folder));
  if (auto ok = check_target_in(folder, real); !ok) return tl::unexpected(ok.error());
  std::filesystem::path name;
  auto fd = open_nameless(folder, name);
  if (!fd) return unwritable(target, fd.error().message);
  return OutputFile(std::move(real), std::move(folder), std::move(*fd), std::move(name),
                    std::move(stop));
}

OutputFile::OutputFile(std::filesystem::path target, std::filesystem::path folder,
                       FileDescriptor fd, std::filesystem::path name, std::stop_token stop)
    : target_(std::move(target)),
      folder_(std::move(folder)),
      fd_(std::move(fd)),
      name_(std::move(name)),
      stop_(std::move(stop)),
      buffer_(new char[kBuffer]) {}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : target_(std::move(other.target_)),
      folder_(std::move(other.folder_)),
      fd_(std::move(other.fd_)),
      name_(std::exchange(other.name_, {})),
      stop_(std::move(other.stop_)),
      buffer_(std::move(other.buffer_)),
      used_(std::exchange(other.used_, 0)),
      failure_(other.failure_) {}

OutputFile::~OutputFile() {
  if (!name_.empty()) ::unlink(name_.c_str());
}

void OutputFile::flush() {
  if (failure_ == 0 && stop_.stop_requested()) failure_ = ECANCELED;
  if (failure_ == 0 && !write_all(fd_.get(), buffer_.get(), used_)) failure_ = errno;
  used_ = 0;
}

char* OutputFile::reserve(std::size_t size) {
  if (kBuffer - used_ < size) flush();
  return buffer_.get() + used_;
}

void OutputFile::write(const void* bytes, std::size_t size) {
  if (size < kBuffer && size <= kBuffer - used_) {
    if (size > 0) std::memcpy(buffer_.get() + used_, bytes, size);
    used_ += size;
    return;
  }
  flush();
  // A large piece bypasses the buffer, in blocks, so that a request to stop is noticed.
  const char* at = static_cast<const char*>(bytes);
  for (; size >= kBuffer && failure_ == 0; at += kBuffer, size -= kBuffer) {
    if (stop_.stop_requested()) failure_ = ECANCELED;
    if (failure_ == 0 && !write_all(fd_.get(), at, kBuffer)) failure_ = errno;
  }
  if (failure_ != 0) return;
  std::memcpy(buffer_.get(), at, size);
  used_ = size;
}

void OutputFile::number(double value) {
  constexpr std::size_t kLongest = 32;
  char* at = reserve(kLongest);
  used_ += static_cast<std::size_t>(std::to_chars(at, at + kLongest, value).ptr - at);
}

void OutputFile::number(std::int64_t value) {
  constexpr std::size_t kLongest = 20;
  char* at = reserve(kLongest);
  used_ += static_cast<std::size_t>(std::to_chars(at, at + kLongest, value).ptr - at);
}

Result<void> OutputFile::finish() {
  flush();
  if (failure_ == 0) return {};
  return unwritable(target_, failure_ == ECANCELED ? "interrupted" : std::strerror(failure_));
}

std::uint64_t OutputFile::size() const {
  struct stat status {};
  return ::fstat(fd_.get(), &status) == 0 ? static_cast<std::uint64_t>(status.st_size) : 0;
}

FileDescriptor OutputFile::share() const {
  return FileDescriptor(::fcntl(fd_.get(), F_DUPFD_CLOEXEC, 0));
}

Result<void> OutputFile::copy_out() const {
  if (::lseek(fd_.get(), 0, SEEK_SET) != 0) return unwritable(target_, std::strerror(errno));
  if (const int problem = copy_stream(fd_.get(), STDOUT_FILENO, stop_))
    return unwritable(target_, problem == ECANCELED ? "interrupted" : std::strerror(problem));
  return {};
}

Result<void> OutputFile::give_name() {
  if (!name_.empty()) return {};
  const std::string self = "/proc/self/fd/" + std::to_string(fd_.get());
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const std::filesystem::path name = hidden_name(folder_);
    if (::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0) {
      name_ = name;
      return {};
    }
    if (errno != EEXIST) break;
  }
  return unwritable(target_, std::strerror(errno));
}

Result<void> commit(std::vector<OutputFile>& files) {
  for (OutputFile& file : files)
    if (auto done = file.finish(); !done) return done;
  NewFolders folders;
  const auto has_name = [](const OutputFile& file) { return file.target_ != kStandardOutput; };
  for (const OutputFile& file : files) {
    if (!has_name(file)) continue;
    if (auto made = folders.make(file.target_, file.folder_); !made) return made;
    if (auto ok = check_target(file.target_); !ok) return ok;
  }
  for (OutputFile& file : files)
    if (auto named = has_name(file) ? file.give_name() : file.copy_out(); !named) return named;
  for (OutputFile& file : files) {
    if (!has_name(file)) continue;
    if (::rename(file.name_.c_str(), file.target_.c_str()) != 0)
      return unwritable(file.target_, std::strerror(errno));
    file.name_.clear();
  }
  folders.keep();
  return {};
}

}  // namespace weft::files

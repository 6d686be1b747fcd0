// SPDX-License-Identifier: Apache-2.0
// Files that appear complete or not at all.
//
// An OutputFile is written without a name in the folder of its target (O_TMPFILE; if the file
// system has no such files, under a hidden name that is removed again), so nothing is left
// behind, whatever ends the process. `commit` then moves all files of a set into place: each
// replaces an older file in one step, and no name appears before all contents are complete. A stop
// that is requested before the first is moved undoes all; later it has no effect. A file for
// kStandardOutput is copied there by `commit`, when all are complete.
//
//   auto file = OutputFile::create("mesh.vtu", stop);
//   file->put("<VTKFile>");
//   std::vector<OutputFile> files; files.push_back(std::move(*file));
//   Result<void> done = commit(files);
//
// Errors (kUnwritableOutput) name the target and the reason. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "files/base/data_path.h"
#include "files/base/error.h"

namespace weft::files {

// A descriptor that closes itself.
class FileDescriptor {
 public:
  FileDescriptor() = default;
  explicit FileDescriptor(int fd) : fd_(fd) {}
  FileDescriptor(FileDescriptor&& other) noexcept : fd_(std::exchange(other.fd_, kClosed)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~FileDescriptor() { reset(); }
  int get() const { return fd_; }
  bool is_open() const { return fd_ != kClosed; }
  void reset();

 private:
  static constexpr int kClosed = -1;
  int fd_ = kClosed;
};

// A nameless file in `folder` for reading and writing. If it needs a name for a while, `name`
// receives it and the caller removes it.
Result<FileDescriptor> open_nameless(const std::filesystem::path& folder,
                                     std::filesystem::path& name);

// The same without any name: it vanishes with its descriptor, whatever ends the process.
Result<FileDescriptor> open_unlinked(const std::filesystem::path& folder);

// Writes all bytes at the descriptor's position; returns false with errno set on failure.
bool write_all(int fd, const void* bytes, std::size_t size);

// Succeeds if a file can be put at `target`: its folder exists and is writable, and an existing
// `target` is a regular file.
Result<void> check_target(const std::filesystem::path& target);

enum class MissingFolders { kRefuse, kMake };

class OutputFile {
 public:
  // With kMake, `commit` makes the folders of `target` that are missing, and not earlier.
  static Result<OutputFile> create(const std::filesystem::path& target, std::stop_token stop,
                                   MissingFolders missing = MissingFolders::kRefuse);

  OutputFile(OutputFile&&) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;
  ~OutputFile();

  // Appends. A failure is kept: later writes do nothing, and `finish` reports it.
  void write(const void* bytes, std::size_t size);
  void put(std::string_view text) { write(text.data(), text.size()); }
  void put(char c) { *reserve(1) = c, ++used_; }
  template <class T>
  void put_array(std::span<const T> values) {
    write(values.data(), values.size_bytes());
  }
  template <class T>
  void put_raw(const T& value) {
    write(&value, sizeof value);
  }
  // Appends a number as the shortest text that reads back the same.
  void number(double value);
  void number(std::int64_t value);

  // Keeps this failure, an errno, unless there was one before.
  void fail(int problem) { failure_ = failure_ == 0 ? problem : failure_; }

  // Flushes; returns the first failure of any write, if there was one. A requested stop counts.
  // More may be written after that.
  Result<void> finish();
  const std::filesystem::path& target() const { return target_; }
  // In bytes. REQUIRES: finished.
  std::uint64_t size() const;
  // Another descriptor of the file, for reading what was flushed while more is written; not open if
  // there are too many.
  FileDescriptor share() const;
  // The file itself, without a name: it vanishes with the descriptor. REQUIRES: finished; nothing
  // else is called any more.
  FileDescriptor take() { return std::move(fd_); }
  // An existing folder, on the file system of the target: its own, or the nearest above it.
  const std::filesystem::path& folder() const { return folder_; }

 private:
  friend Result<void> commit(std::vector<OutputFile>& files);
  static constexpr std::size_t kBuffer = std::size_t{1} << 20;

  OutputFile(std::filesystem::path target, std::filesystem::path folder, FileDescriptor fd,
             std::filesystem::path name, std::stop_token stop);
  char* reserve(std::size_t size);
  void flush();
  // REQUIRES: finished, and the target is standard output.
  Result<void> copy_out() const;
  // Gives the file a hidden name in `folder`, from which it can be moved.
  Result<void> give_name();

  std::filesystem::path target_;
  std::filesystem::path folder_;
  FileDescriptor fd_;
  std::filesystem::path name_;  // empty while nameless
  std::stop_token stop_;
  std::unique_ptr<char[]> buffer_;
  std::size_t used_ = 0;
  int failure_ = 0;  // errno of the first failed write
};

// Moves every file into place, or none, as far as the file system allows: all are complete and
// named before the first is moved.
Result<void> commit(std::vector<OutputFile>& files);

}  // namespace weft::files

// SPDX-License-Identifier: Apache-2.0
#include "client/formats/files/file_contents.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <new>
#include <string>

namespace weft::client {

Result<FileContents> read_file(const std::filesystem::path& path, std::uint64_t limit) {
  const auto refuse = [&path](const std::string& why) {
    return fail(ExitCode::kUnreadableInput, path.string() + ": " + why);
  };
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return refuse(std::strerror(errno));
  struct Closer {
    int fd;
    ~Closer() { ::close(fd); }
  } closer{fd};

  struct stat status {};
  if (::fstat(fd, &status) != 0) return refuse(std::strerror(errno));
  if (!S_ISREG(status.st_mode)) return refuse("is not a regular file");
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (size > limit)
    return refuse("has " + std::to_string(size) + " bytes, the limit is " + std::to_string(limit));

  FileContents contents;
  contents.bytes_.reset(new (std::nothrow) char[size + 1]);
  if (!contents.bytes_) return refuse("not enough memory for " + std::to_string(size) + " bytes");
  while (contents.size_ < size) {
    const ssize_t got = ::read(fd, contents.bytes_.get() + contents.size_, size - contents.size_);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return refuse(std::strerror(errno));
    if (got == 0) break;  // the file became shorter meanwhile
    contents.size_ += static_cast<std::size_t>(got);
  }
  return contents;
}

}  // namespace weft::client

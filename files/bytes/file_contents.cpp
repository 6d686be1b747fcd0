// SPDX-License-Identifier: Apache-2.0
#include "files/bytes/file_contents.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>
#include <string>
#include <utility>

namespace weft::files {
namespace {

constexpr std::string_view kUtf8Mark = "\xef\xbb\xbf";
constexpr std::string_view kUtf16LittleMark = "\xff\xfe";
constexpr std::string_view kUtf16BigMark = "\xfe\xff";
constexpr std::string_view kUtf32LittleMark{"\xff\xfe\0\0", 4};

// The number of bytes that the character takes in UTF-8.
std::size_t put_utf8(std::uint32_t c, char* out) {
  const auto tail = [c](int shift) { return static_cast<char>(0x80 | ((c >> shift) & 0x3f)); };
  if (c < 0x80) {
    out[0] = static_cast<char>(c);
    return 1;
  }
  if (c < 0x800) {
    out[0] = static_cast<char>(0xc0 | (c >> 6));
    out[1] = tail(0);
    return 2;
  }
  if (c < 0x10000) {
    out[0] = static_cast<char>(0xe0 | (c >> 12));
    out[1] = tail(6);
    out[2] = tail(0);
    return 3;
  }
  out[0] = static_cast<char>(0xf0 | (c >> 18));
  out[1] = tail(12);
  out[2] = tail(6);
  out[3] = tail(0);
  return 4;
}

// Writes UTF-16 as UTF-8; returns its size, or what is wrong with it. `out`: room for 3 bytes for
// each unit of `in`.
tl::expected<std::size_t, std::string> utf8_of_utf16(std::string_view in, bool big, char* out) {
  const auto unit = [in, big](std::size_t at) -> std::uint32_t {
    const auto first = static_cast<unsigned char>(in[at]);
    const auto second = static_cast<unsigned char>(in[at + 1]);
    return big ? first << 8 | second : second << 8 | first;
  };
  if (in.size() % 2 != 0)
    return tl::unexpected(std::string("begins as UTF-16, but has an odd number of bytes"));
  std::size_t size = 0;
  for (std::size_t at = 0; at < in.size(); at += 2) {
    std::uint32_t c = unit(at);
    if (c >= 0xd800 && c < 0xe000) {
      const bool is_pair =
          c < 0xdc00 && at + 3 < in.size() && unit(at + 2) >= 0xdc00 && unit(at + 2) < 0xe000;
      // The mark takes two bytes more.
      if (!is_pair)
        return tl::unexpected("begins as UTF-16, but byte " + std::to_string(at + 2) +
                              " is half of a character");
      at += 2;
      c = 0x10000 + ((c - 0xd800) << 10) + (unit(at) - 0xdc00);
    }
    size += put_utf8(c, out + size);
  }
  return size;
}

// A line may end in any number of carriage returns and a line feed, as text that was translated
// twice does, or in a carriage return alone.
void end_lines_by_line_feeds(char* text, std::size_t size) {
  char* const end = text + size;
  for (char* at = text; (at = static_cast<char*>(std::memchr(
                             at, '\r', static_cast<std::size_t>(end - at)))) != nullptr;) {
    char* after = at;
    while (after < end && *after == '\r') ++after;
    if (after == end || *after != '\n') std::fill(at, after, '\n');
    at = after;
    if (at == end) break;
  }
}

}  // namespace

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

Result<FileContents> read_text_file(const std::filesystem::path& path, std::uint64_t limit,
                                    LineEnds ends) {
  auto contents = read_file(path, limit);
  if (!contents) return contents;
  const auto refuse = [&path](const std::string& why) {
    return fail(ExitCode::kUnreadableInput, path.string() + ": " + why);
  };
  const std::string_view text = contents->text();
  if (text.starts_with(kUtf32LittleMark)) return refuse("is UTF-32: save it as UTF-8");
  const bool big = text.starts_with(kUtf16BigMark);
  if (big || text.starts_with(kUtf16LittleMark)) {
    const std::string_view units = text.substr(kUtf16BigMark.size());
    const std::size_t most = units.size() / 2 * 3;
    std::unique_ptr<char[]> utf8(new (std::nothrow) char[most + 1]);
    if (!utf8) return refuse("not enough memory for " + std::to_string(most) + " bytes");
    const auto size = utf8_of_utf16(units, big, utf8.get());
    if (!size) return refuse(size.error());
    contents->bytes_ = std::move(utf8);
    contents->size_ = *size;
  } else if (text.starts_with(kUtf8Mark)) {
    contents->start_ = kUtf8Mark.size();
    contents->size_ -= kUtf8Mark.size();
  }
  if (ends == LineEnds::kLineFeeds)
    end_lines_by_line_feeds(contents->bytes_.get() + contents->start_, contents->size_);
  return contents;
}

}  // namespace weft::files

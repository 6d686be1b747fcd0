// SPDX-License-Identifier: Apache-2.0
// The bytes of an input file, or its text. Errors (kUnreadableInput) name the file and the reason:
// missing, not readable, a folder, larger than the limit, or not the UTF-16 that it begins as.
//
// The text of a file is what programs of any system mean by it: without a byte order mark, in UTF-8
// even if the file is UTF-16 with a mark, and with line feeds at the ends of its lines, although a
// carriage return may stand before each. What the text is encoded in without a mark is not asked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

#include "files/base/error.h"

namespace weft::files {

// Whether carriage returns that end a line alone become line feeds: not in files that hold binary
// sections, too.
enum class LineEnds { kLineFeeds, kAsTheyAre };

class FileContents {
 public:
  std::string_view text() const { return {bytes_.get() + start_, size_}; }

 private:
  friend Result<FileContents> read_file(const std::filesystem::path& path, std::uint64_t limit);
  friend Result<FileContents> read_text_file(const std::filesystem::path& path, std::uint64_t limit,
                                             LineEnds ends);
  std::unique_ptr<char[]> bytes_;
  std::size_t start_ = 0;
  std::size_t size_ = 0;
};

Result<FileContents> read_file(const std::filesystem::path& path, std::uint64_t limit);
Result<FileContents> read_text_file(const std::filesystem::path& path, std::uint64_t limit,
                                    LineEnds ends = LineEnds::kLineFeeds);

}  // namespace weft::files

// SPDX-License-Identifier: Apache-2.0
// The bytes of an input file. Errors (kUnreadableInput) name the file and the reason: missing, not
// readable, a folder, or larger than the limit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

#include "client/base/error.h"

namespace weft::client {

class FileContents {
 public:
  std::string_view text() const { return {bytes_.get(), size_}; }

 private:
  friend Result<FileContents> read_file(const std::filesystem::path& path, std::uint64_t limit);
  std::unique_ptr<char[]> bytes_;
  std::size_t size_ = 0;
};

Result<FileContents> read_file(const std::filesystem::path& path, std::uint64_t limit);

}  // namespace weft::client

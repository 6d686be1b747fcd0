// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace weft::files {

// A ZIP archive of files by their names, uncompressed, without checksums, which are not read.
inline std::string zip_of(const std::vector<std::pair<std::string, std::string>>& members) {
  const auto bytes = [](auto value) {
    return std::string(reinterpret_cast<const char*>(&value), sizeof value);
  };
  std::string out;
  std::string directory;
  for (const auto& [name, data] : members) {
    const auto size = static_cast<std::uint32_t>(data.size());
    const auto sizes = bytes(size) + bytes(size) + bytes(static_cast<std::uint16_t>(name.size()));
    directory += "PK\1\2" + std::string(16, '\0') + sizes + std::string(12, '\0') +
                 bytes(static_cast<std::uint32_t>(out.size())) + name;
    out += "PK\3\4" + std::string(14, '\0') + sizes + std::string(2, '\0') + name + data;
  }
  const auto count = static_cast<std::uint16_t>(members.size());
  return out + directory + "PK\5\6" + std::string(4, '\0') + bytes(count) + bytes(count) +
         bytes(static_cast<std::uint32_t>(directory.size())) +
         bytes(static_cast<std::uint32_t>(out.size())) + std::string(2, '\0');
}

}  // namespace weft::files

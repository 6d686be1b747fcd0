// SPDX-License-Identifier: Apache-2.0
#include "files/bytes/shapefile_index.h"

#include <cstddef>
#include <cstdint>

#include "files/bytes/big_endian.h"

namespace weft::files {
namespace {

constexpr std::size_t kHeader = 100;  // bytes of both files
constexpr std::size_t kRecordHeader = 8;
constexpr std::uint32_t kFileCode = 9994;

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < sizeof value; ++i)
    value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

}  // namespace

std::string index_of_shapes(std::string_view shp) {
  if (shp.size() < kHeader || number_at(shp, 0) != kFileCode) return "";
  std::string shx(shp.substr(0, kHeader));
  const auto put = [&shx](std::size_t bytes) {  // as a count of words
    const auto words = big_endian(static_cast<std::uint32_t>(bytes / 2));
    shx.append(words.data(), words.size());
  };
  for (std::size_t at = kHeader; at + kRecordHeader <= shp.size();) {
    const std::size_t size = std::size_t{2} * number_at(shp, at + 4);
    if (size > shp.size() - at - kRecordHeader) break;
    put(at);
    put(size);
    at += kRecordHeader + size;
  }
  const auto length = big_endian(static_cast<std::uint32_t>(shx.size() / 2));
  constexpr std::size_t kLength = 24;  // where the header has it
  shx.replace(kLength, length.size(), length.data(), length.size());
  return shx;
}

}  // namespace weft::files

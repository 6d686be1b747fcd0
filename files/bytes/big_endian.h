// SPDX-License-Identifier: Apache-2.0
// Numbers with the most significant byte first, as NetCDF and SELAFIN have them.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "files/base/atomic_file.h"

namespace weft::files {

template <class T>
std::array<char, sizeof(T)> big_endian(T value) {
  static_assert(std::endian::native == std::endian::little);
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
  return bytes;
}

template <class T>
void put_big_endian(OutputFile& file, T value) {
  const auto bytes = big_endian(value);
  file.write(bytes.data(), bytes.size());
}

}  // namespace weft::files

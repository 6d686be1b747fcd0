// SPDX-License-Identifier: Apache-2.0
// Arrays of numbers as they are in memory, in bounded memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "files/base/atomic_file.h"
#include "files/formats/mesh.h"

namespace weft::files {

// One value `count` times.
template <class T>
void put_equal(OutputFile& file, T value, std::size_t count) {
  constexpr std::size_t kBlock = 1 << 14;
  const std::vector<T> block(std::min(count, kBlock), value);
  for (; count > 0; count -= std::min(count, kBlock))
    file.put_array(std::span<const T>(block).first(std::min(count, kBlock)));
}

// An array of the mesh.
template <class T>
void put_values(OutputFile& file, const MeshView& mesh, std::span<const T> values) {
  in_pieces(mesh.pages, values, [&file](std::span<const T> piece) { file.put_array(piece); });
}

}  // namespace weft::files

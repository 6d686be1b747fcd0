// SPDX-License-Identifier: Apache-2.0
// The path of a file of data, and its format.
//
//   DataPath file = "plate.poly";      // of the format .poly
//   DataPath piped = kStandardInput;
//   piped.format = ".geojson";
#pragma once

#include <filesystem>
#include <string>

#include "files/base/words.h"

namespace weft::files {

// What `-` stands for on the command line. No extension tells their formats.
inline constexpr const char* kStandardInput = "/dev/stdin";
inline constexpr const char* kStandardOutput = "/dev/stdout";

struct DataPath : std::filesystem::path {
  using path::path;
  DataPath() = default;
  DataPath(const path& name) : path(name) {}

  std::string format;  // an extension in lower case, ".vtu"; empty: that of the name
};

// The extension of the format.
inline std::string extension_of(const DataPath& file) {
  return file.format.empty() ? file.extension().string() : file.format;
}
inline std::string lower_extension(const DataPath& file) {
  return lower_case(extension_of(file));
}

}  // namespace weft::files

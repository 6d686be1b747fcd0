// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/law.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

namespace weft::fuzz {
namespace {

std::string hash_of(const std::uint8_t* input, std::size_t size) {
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a
  for (std::size_t i = 0; i < size; ++i) hash = (hash ^ input[i]) * 1099511628211u;
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

}  // namespace

void broken(std::string_view law, const std::string& evidence, const std::uint8_t* input,
            std::size_t size) {
  const char* const folder = std::getenv("WEFT_FUZZ_FINDINGS");
  if (folder == nullptr || *folder == 0) {
    std::fprintf(stderr, "broken law: %.*s\n%s\n", static_cast<int>(law.size()), law.data(),
                 evidence.c_str());
    std::abort();
  }
  static std::map<std::string, int, std::less<>> kept;  // targets run on one thread
  if (++kept[std::string(law)] > kKept) return;
  std::filesystem::create_directories(folder);
  const std::filesystem::path file =
      std::filesystem::path(folder) / (std::string(law) + "-" + hash_of(input, size));
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(input), static_cast<std::streamsize>(size));
  std::ofstream(file.string() + ".txt") << evidence;
}

}  // namespace weft::fuzz

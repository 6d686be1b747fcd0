// SPDX-License-Identifier: Apache-2.0
// The manifests of `weft batch`: any bytes are an error with a sentence, or at least one mesh, each
// with a name of its own and an input.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <string_view>

#include "client/batch/manifest.h"
#include "tests/files/support/temp_folder.h"
#include "tests/fuzz/law.h"

namespace weft::fuzz {
namespace {

void judge(const std::uint8_t* data, std::size_t size) {
  static const files::TempFolder folder(std::filesystem::is_directory("/dev/shm")
                                            ? std::filesystem::path("/dev/shm")
                                            : std::filesystem::temp_directory_path());
  const auto file =
      folder.write("in.yaml", std::string_view(reinterpret_cast<const char*>(data), size));
  const auto must = [&](bool holds, std::string_view law, const std::string& evidence) {
    if (!holds) broken(law, evidence, data, size);
  };
  const auto meshes = client::read_manifest(file);
  if (!meshes) return must(!meshes.error().message.empty(), "error", "no sentence");
  must(!meshes->empty(), "meshes", "none");
  std::set<std::string> names;
  for (const client::BatchMesh& mesh : *meshes) {
    must(!mesh.name.empty() && names.insert(mesh.name).second, "name", mesh.name);
    must(!mesh.input.empty(), "input", mesh.name);
  }
}

}  // namespace
}  // namespace weft::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  weft::fuzz::judge(data, size);
  return 0;
}

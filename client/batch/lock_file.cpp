// SPDX-License-Identifier: Apache-2.0
#include "client/batch/lock_file.h"

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "files/base/atomic_file.h"
#include "files/base/text.h"

namespace weft::client {

void LockFile::add(const std::string& name, const v1::Summary& summary) {
  engine_version = summary.engine_version();
  meshes[name] = {hex(summary.sha256()), summary.triangles(), summary.vertices()};
}

std::optional<std::string> LockFile::change(const std::string& name, const LockFile& now) const {
  const auto then = meshes.find(name);
  if (then == meshes.end()) return "the mesh is not locked yet";
  const LockedMesh& mesh = now.meshes.at(name);
  if (mesh.digest == then->second.digest) return std::nullopt;
  std::string what = "the mesh has changed: " + with_separators(mesh.triangles) + " triangles, " +
                     with_separators(then->second.triangles) + " before; digest " +
                     mesh.digest.substr(0, 12) + ", " + then->second.digest.substr(0, 12) +
                     " before";
  if (now.engine_version != engine_version)
    what += "; engine version " + now.engine_version + ", " + engine_version + " before";
  return what;
}

Result<LockFile> read_lock_file(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream)
    return fail(ExitCode::kUnreadableInput,
                file.string() +
                    ": there is no such lock file; `weft batch` without --locked "
                    "makes it");
  const std::string text(std::istreambuf_iterator<char>(stream), {});
  try {
    const auto json = nlohmann::json::parse(text);
    LockFile lock{.engine_version = json.at("engine_version").get<std::string>()};
    for (const auto& [name, mesh] : json.at("meshes").items()) {
      lock.meshes[name] = {mesh.at("digest").get<std::string>(),
                           mesh.at("triangles").get<std::uint64_t>(),
                           mesh.at("vertices").get<std::uint64_t>()};
    }
    return lock;
  } catch (const nlohmann::json::exception& error) {
    return fail(ExitCode::kUnreadableInput,
                file.string() + ": not a lock file: " + harmless(error.what()));
  }
}

Result<void> write_lock_file(const std::filesystem::path& file, const LockFile& lock) {
  nlohmann::ordered_json json = {{"engine_version", lock.engine_version}};
  for (const auto& [name, mesh] : lock.meshes) {
    json["meshes"][name] = {
        {"digest", mesh.digest}, {"triangles", mesh.triangles}, {"vertices", mesh.vertices}};
  }
  auto output = OutputFile::create(file, {});
  if (!output) return tl::unexpected(output.error());
  output->put(json.dump(2, ' ', true, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  std::vector<OutputFile> files;
  files.push_back(std::move(*output));
  return commit(files);
}

}  // namespace weft::client

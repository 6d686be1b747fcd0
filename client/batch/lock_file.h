// SPDX-License-Identifier: Apache-2.0
// The digests of a batch's meshes, kept in a file under version control: if a mesh changes, the
// file changes, and a review sees it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "client/base/files.h"
#include "files/base/error.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::client {

struct LockedMesh {
  std::string digest;  // hexadecimal
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;
};

struct LockFile {
  std::string engine_version{};
  std::map<std::string, LockedMesh> meshes{};  // by name

  void add(const std::string& name, const v1::Summary& summary);
  // "the mesh has changed: ..." if `now` is not what is locked; nullopt if it is.
  std::optional<std::string> change(const std::string& name, const LockFile& now) const;
};

// Errors: kUnreadableInput if the file is missing or malformed, kUnwritableOutput.
Result<LockFile> read_lock_file(const std::filesystem::path& file);
Result<void> write_lock_file(const std::filesystem::path& file, const LockFile& lock);

}  // namespace weft::client

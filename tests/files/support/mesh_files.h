// SPDX-License-Identifier: Apache-2.0
// Writes a mesh and reads it back.
#pragma once

#include <utility>
#include <vector>

#include "files/formats/mesh_formats.h"
#include "tests/files/support/temp_folder.h"

namespace weft::files {

inline Result<void> write_files(const MeshView& mesh, const std::filesystem::path& path) {
  std::vector<OutputFile> files;
  for (const auto& name : mesh_files(path))
    files.push_back(std::move(OutputFile::create(name, {}).value()));
  write_mesh(*mesh_format(path), mesh, files);
  return commit(files);
}

inline Result<Mesh> round_trip(const Mesh& mesh, const std::string& name) {
  TempFolder folder;
  if (auto written = write_files(mesh.view(), folder / name); !written)
    return tl::unexpected(written.error());
  return read_mesh(folder / name);
}

}  // namespace weft::files

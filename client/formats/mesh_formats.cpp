// SPDX-License-Identifier: Apache-2.0
#include "client/formats/mesh_formats.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>
#include <string>

#include "client/formats/geojson.h"
#include "client/formats/msh.h"
#include "client/formats/triangle_mesh.h"
#include "client/formats/triangle_poly.h"
#include "client/formats/vtu.h"
#include "client/text.h"

namespace weft::client {
namespace {

std::string extension(const std::filesystem::path& path) {
  std::string out = path.extension().string();
  std::transform(out.begin(), out.end(), out.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return out;
}

}  // namespace

std::optional<MeshFormat> mesh_format(const std::filesystem::path& path) {
  const std::string name = extension(path);
  if (name == ".vtu") return MeshFormat::kVtu;
  if (name == ".msh") return MeshFormat::kMsh;
  if (name == ".node" || name == ".ele") return MeshFormat::kTriangle;
  return std::nullopt;
}

tl::unexpected<Error> unknown_mesh_format(const std::filesystem::path& path) {
  return fail(ExitCode::kUsage, path.string() + ": the extension " +
                                    in_quotes(path.extension().string()) +
                                    " is not that of a mesh format: .vtu, .msh, .node");
}

std::vector<std::filesystem::path> mesh_files(const std::filesystem::path& path) {
  if (mesh_format(path) != MeshFormat::kTriangle) return {path};
  std::vector<std::filesystem::path> files;
  for (const char* name : {".node", ".ele", ".poly"})
    files.push_back(std::filesystem::path(path).replace_extension(name));
  return files;
}

void write_mesh(MeshFormat format, const MeshView& mesh, std::span<OutputFile> files) {
  switch (format) {
    case MeshFormat::kVtu:
      return write_vtu(mesh, files[0]);
    case MeshFormat::kMsh:
      return write_msh(mesh, files[0]);
    case MeshFormat::kTriangle:
      return write_triangle_mesh(mesh, files[0], files[1], files[2]);
  }
}

Result<Mesh> read_mesh(const std::filesystem::path& path) {
  const auto format = mesh_format(path);
  if (!format) return unknown_mesh_format(path);
  try {
    switch (*format) {
      case MeshFormat::kVtu:
        return read_vtu(path);
      case MeshFormat::kMsh:
        return read_msh(path);
      case MeshFormat::kTriangle:
        return read_triangle_mesh(path);
    }
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  return fail(ExitCode::kUnreadableInput, path.string() + ": not enough memory to read it");
}

bool is_domain_path(const std::filesystem::path& path) {
  const std::string name = extension(path);
  return name == ".poly" || name == ".geojson" || name == ".json";
}

tl::unexpected<Error> unknown_domain_format(const std::filesystem::path& path) {
  return fail(ExitCode::kUsage, path.string() + ": the extension " +
                                    in_quotes(path.extension().string()) +
                                    " is not that of a domain: .poly, .geojson, .json");
}

Result<Domain> read_domain(const std::filesystem::path& path) {
  if (!is_domain_path(path)) return unknown_domain_format(path);
  try {
    return extension(path) == ".poly" ? read_triangle_poly(path) : read_geojson(path);
  } catch (const std::bad_alloc&) {
    return fail(ExitCode::kUnreadableInput, path.string() + ": not enough memory to read it");
  }
}

Result<Mesh> validated(const std::filesystem::path& path, Mesh mesh) {
  const auto refuse = [&path](const std::string& why) {
    return fail(ExitCode::kUnreadableInput, path.string() + ": " + why);
  };
  const std::size_t vertices = mesh.coordinates.size() / 2;
  for (std::size_t i = 0; i < mesh.coordinates.size(); ++i)
    if (!std::isfinite(mesh.coordinates[i]))
      return refuse("vertex " + std::to_string(i / 2) + " has a coordinate that is not finite");
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (mesh.triangles[i] >= vertices)
      return refuse("triangle " + std::to_string(i / 3) + " has vertex " +
                    std::to_string(mesh.triangles[i]) + " of " + std::to_string(vertices));
  for (std::size_t i = 0; i < mesh.edges.size(); ++i)
    if (mesh.edges[i] >= vertices)
      return refuse("edge " + std::to_string(i / 2) + " has vertex " +
                    std::to_string(mesh.edges[i]) + " of " + std::to_string(vertices));
  mesh.regions.resize(mesh.triangles.size() / 3);
  mesh.edge_markers.resize(mesh.edges.size() / 2);
  return mesh;
}

}  // namespace weft::client

// SPDX-License-Identifier: Apache-2.0
#include "files/formats/mesh_formats.h"

#include <cerrno>
#include <cmath>
#include <new>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "files/base/text.h"
#include "files/base/words.h"
#include "files/formats/bed.h"
#include "files/formats/derived/faces.h"
#include "files/formats/derived/mesh_edges.h"
#include "files/formats/derived/middles.h"
#include "files/formats/derived/periodic_nodes.h"
#include "files/formats/derived/second_order.h"
#include "files/formats/format_names.h"
#include "files/formats/meshes/adcirc.h"
#include "files/formats/meshes/exodus.h"
#include "files/formats/meshes/geojson_mesh.h"
#include "files/formats/meshes/inp.h"
#include "files/formats/meshes/medit.h"
#include "files/formats/meshes/mfem.h"
#include "files/formats/meshes/modflow.h"
#include "files/formats/meshes/msh.h"
#include "files/formats/meshes/netgen.h"
#include "files/formats/meshes/npz.h"
#include "files/formats/meshes/openfoam.h"
#include "files/formats/meshes/selafin.h"
#include "files/formats/meshes/sms.h"
#include "files/formats/meshes/su2.h"
#include "files/formats/meshes/surface_formats.h"
#include "files/formats/meshes/ugrid.h"
#include "files/formats/meshes/vtu.h"
#include "files/formats/meshes/xdmf.h"
#include "files/formats/standard_streams.h"
#include "files/formats/triangle/triangle_edges.h"
#include "files/formats/triangle/triangle_mesh.h"

namespace weft::files {
namespace {

using Files = std::span<OutputFile>;
using Options = MeshWriteOptions;

// A writer that makes one file and takes no options.
template <void (*write)(const MeshView&, OutputFile&)>
void one_file(const MeshView& mesh, Files files, const Options&) {
  write(mesh, files[0]);
}

void write_gmsh(const MeshView& mesh, Files files, const Options& options) {
  const std::vector<PeriodicNodes> periodic = periodic_nodes(mesh, options.periodic);
  options.msh_version == MshVersion::k22 ? write_msh22(mesh, periodic, files[0])
                                         : write_msh(mesh, periodic, files[0]);
}

void write_triangle(const MeshView& mesh, Files files, const Options&) {
  write_triangle_mesh(mesh, files[0], files[1], files[2]);
}

void write_adcirc_mesh(const MeshView& mesh, Files files, const Options& options) {
  write_adcirc(mesh, options.open_boundaries, files[0]);
}

void write_xdmf_mesh(const MeshView& mesh, Files files, const Options&) {
  write_xdmf(mesh, files[0], files[1]);
}

void write_openfoam_mesh(const MeshView& mesh, Files files, const Options&) {
  write_openfoam(mesh, files);
}

std::vector<std::filesystem::path> xdmf_files(const std::filesystem::path& path) {
  return {path, path.string() + ".bin"};
}

std::vector<std::filesystem::path> triangle_files(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> files;
  for (const char* name : {".node", ".ele", ".poly"})
    files.push_back(std::filesystem::path(path).replace_extension(name));
  return files;
}

constexpr MeshFormat kFormats[] = {
    {.extension = ".vtu",
     .second_order = true,
     .write = one_file<write_vtu>,
     .read = read_vtu,
     .read_values = read_vtu_values,
     .values = CarriesValues::kAll,
     .parts = true,
     .marker_names = any_name,
     .region_names = any_name},
    {.extension = ".msh",
     .second_order = true,
     .write = write_gmsh,
     .read = read_msh,
     .read_values = read_msh_values,
     .values = CarriesValues::kAll,
     .marker_names = gmsh_name,
     .region_names = gmsh_name},
    {.extension = ".node",
     .files = triangle_files,
     .needs_name = true,
     .second_order = true,
     .write = write_triangle,
     .read = read_triangle_mesh,
     .marker_names = any_name,
     .region_names = any_name},
    {.extension = ".ele", .needs_name = true, .read = read_triangle_mesh},
    {.extension = ".edge", .write = one_file<write_triangle_edges>},
    {.extension = ".neigh", .write = one_file<write_triangle_neighbours>},
    {.extension = ".14",
     .write = write_adcirc_mesh,
     .read = read_adcirc,
     .read_values = read_adcirc_values,
     .values = CarriesValues::kBed,
     .open_boundaries = true},
    {.extension = ".grd",
     .write = write_adcirc_mesh,
     .read = read_adcirc,
     .read_values = read_adcirc_values,
     .values = CarriesValues::kBed,
     .open_boundaries = true},
    {.extension = ".gr3",
     .write = write_adcirc_mesh,
     .read = read_adcirc,
     .read_values = read_adcirc_values,
     .values = CarriesValues::kBed,
     .open_boundaries = true},
    {.extension = ".2dm",
     .write = one_file<write_2dm>,
     .read = read_2dm,
     .read_values = read_2dm_values,
     .values = CarriesValues::kBed,
     .marker_names = quotable_name,
     .region_names = quotable_name,
     .boundary_only = true},
    {.extension = ".nc",
     .write = one_file<write_ugrid>,
     .read = read_ugrid,
     .read_values = read_ugrid_values,
     .values = CarriesValues::kAll,
     .parts = true,
     .marker_names = flag_meaning,
     .region_names = flag_meaning},
    {.extension = ".slf",
     .write = one_file<write_selafin>,
     .read = read_selafin,
     .read_values = read_selafin_values,
     .values = CarriesValues::kAll},
    {.extension = ".xdmf",
     .files = xdmf_files,
     .second_order = true,
     .write = write_xdmf_mesh,
     .values = CarriesValues::kAll,
     .parts = true,
     .marker_names = any_name,
     .region_names = any_name},
    {.extension = ".exo",
     .second_order = true,
     .write = one_file<write_exodus>,
     .values = CarriesValues::kAll,
     .parts = true,
     .marker_names = exodus_name,
     .region_names = exodus_name},
    {.extension = ".e",
     .second_order = true,
     .write = one_file<write_exodus>,
     .values = CarriesValues::kAll,
     .parts = true,
     .marker_names = exodus_name,
     .region_names = exodus_name},
    {.extension = ".disv", .write = one_file<write_disv>, .values = CarriesValues::kBed},
    {.extension = ".foam",
     .files = openfoam_files,
     .write = write_openfoam_mesh,
     .marker_names = foam_word,
     .region_names = foam_word,
     .boundary_only = true},
    {.extension = ".su2",
     .write = one_file<write_su2>,
     .read = read_su2,
     .marker_names = su2_tag,
     .boundary_only = true},
    {.extension = ".mesh", .write = one_file<write_medit>, .read = read_medit},
    {.extension = ".vol",
     .write = one_file<write_netgen>,
     .read = read_netgen,
     .marker_names = group_word,
     .region_names = group_word},
    {.extension = ".mfem",
     .write = one_file<write_mfem>,
     .read = read_mfem,
     .marker_names = quotable_name,
     .region_names = quotable_name},
    {.extension = ".inp",
     .second_order = true,
     .write = one_file<write_inp>,
     .read = read_inp,
     .marker_names = inp_label,
     .region_names = inp_label,
     .name_case = NameCase::kIgnored},
    {.extension = ".npz",
     .write = one_file<write_npz>,
     .read = read_npz,
     .read_values = read_npz_values,
     .values = CarriesValues::kAll,
     .parts = true,
     .marker_names = any_name,
     .region_names = any_name},
    {.extension = ".geojson",
     .write = one_file<write_geojson_mesh>,
     .marker_names = any_name,
     .region_names = any_name},
    {.extension = ".obj",
     .write = one_file<write_obj>,
     .read = read_obj,
     .marker_names = group_word,
     .region_names = group_word},
    {.extension = ".off", .write = one_file<write_off>, .read = read_off},
    {.extension = ".ply", .write = one_file<write_ply>},
    {.extension = ".stl", .write = one_file<write_stl>},
};

template <class Takes>
std::string extensions(const Takes& takes) {
  std::string list;
  for (const MeshFormat& format : kFormats)
    if (takes(format)) list += (list.empty() ? "" : ", ") + std::string(format.extension);
  return list;
}

tl::unexpected<Error> usage(const DataPath& path, const std::string& why) {
  return fail(ExitCode::kUsage,
              path.string() + ": the extension " + in_quotes(extension_of(path)) + why);
}

std::set<std::int32_t> boundary_markers(const MeshView& mesh) {
  const MeshEdges edges(mesh);
  std::set<std::int32_t> markers;
  for (const std::size_t i : mesh.up_to(mesh.edge_count()))
    if (edges.on_boundary(edges.of_input_edge(i))) markers.insert(mesh.edge_markers[i]);
  return markers;
}

// Returns what `read` returns, or an error if it runs out of memory.
template <class T, class Read>
Result<T> with_memory(const std::filesystem::path& path, const Read& read) {
  try {
    return read();
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  return fail(ExitCode::kUnreadableInput, path.string() + ": not enough memory to read it");
}

}  // namespace

Result<void> find_open_boundaries(MeshWriteOptions& options, const NameTable& markers,
                                  std::span<const std::int32_t> open_in_file) {
  for (const std::string& name : std::exchange(options.open_boundary_names, {})) {
    const auto marker = find_marker(name, markers);
    if (!marker) return tl::unexpected(marker.error());
    options.open_boundaries.push_back(*marker);
  }
  if (!options.opens_boundaries())
    options.open_boundaries.assign(open_in_file.begin(), open_in_file.end());
  return {};
}

const MeshFormat* mesh_format(const DataPath& path) {
  const std::string extension = lower_extension(path);
  for (const MeshFormat& format : kFormats)
    if (format.extension == extension) return &format;
  return nullptr;
}

std::string written_mesh_extensions() {
  return extensions([](const MeshFormat& format) { return format.write != nullptr; });
}

std::string read_mesh_extensions() {
  return extensions([](const MeshFormat& format) { return format.read != nullptr; });
}

tl::unexpected<Error> unknown_mesh_format(const DataPath& path) {
  return usage(path, " is not that of a mesh that is written: " + written_mesh_extensions());
}

Result<void> check_writable(const DataPath& path, const MeshWriteOptions& options) {
  if (auto ok = check_has_format(path, written_mesh_extensions()); !ok) return ok;
  const MeshFormat* format = mesh_format(path);
  if (format == nullptr || format->write == nullptr) return unknown_mesh_format(path);
  if (path == kStandardOutput && format->files != nullptr)
    return fail(ExitCode::kUsage, "standard output is one file, and " +
                                      std::string(format->extension) + " is written as several");
  if (options.order == 2 && !format->second_order)
    return usage(path, " is not that of a mesh of second order: " +
                           extensions([](const MeshFormat& f) { return f.second_order; }));
  return {};
}

std::vector<std::string> not_carried(const DataPath& path, const MeshView& mesh) {
  const MeshFormat& format = *mesh_format(path);
  std::vector<std::string> sentences;
  std::string lost;
  for (const VertexValues& values : mesh.vertex_values)
    if (format.values == CarriesValues::kNone ||
        (format.values == CarriesValues::kBed && !Bed::is_bed(values.name)))
      lost += (lost.empty() ? "" : ", ") + values.name;
  if (!lost.empty())
    sentences.push_back(path.string() +
                        ": the format does not carry these values at vertices: " + lost);
  if (!mesh.parts.empty() && !format.parts)
    sentences.push_back(path.string() + ": the format does not carry the parts of the triangles");
  Names written = names_in(format, *mesh.names);
  if (format.boundary_only && !written.markers.empty()) {
    const std::set<std::int32_t> markers = boundary_markers(mesh);
    std::erase_if(written.markers,
                  [&](const auto& entry) { return !markers.contains(entry.first); });
  }
  add_name_losses(path.string(), *mesh.names, written, sentences);
  return sentences;
}

std::vector<std::filesystem::path> mesh_files(const DataPath& path) {
  const MeshFormat* const format = mesh_format(path);
  return format != nullptr && format->files != nullptr ? format->files(path)
                                                       : std::vector<std::filesystem::path>{path};
}

std::size_t write_mesh(const MeshFormat& format, const MeshView& mesh, std::span<OutputFile> files,
                       const MeshWriteOptions& options) {
  const Names names = names_in(format, *mesh.names);
  MeshView named = mesh;
  named.names = &names;
  const auto fail_all = [files](int problem) {
    for (OutputFile& file : files) file.fail(problem);
  };
  try {
    if (options.order == 2) {
      const SecondOrderMesh second(named);
      format.write(second.view(), files, options);
      return second.straightened();
    }
    format.write(named, files, options);
  } catch (const std::system_error& failure) {
    fail_all(failure.code().value());
  } catch (const std::bad_alloc&) {
    fail_all(ENOMEM);
  }
  return 0;
}

Result<Mesh> read_mesh(const DataPath& path) {
  const MeshFormat* format = mesh_format(path);
  if (format == nullptr || format->read == nullptr)
    return usage(path, " is not that of a mesh that is read: " + read_mesh_extensions());
  return with_memory<Mesh>(path, [&] { return format->read(path); });
}

Result<void> check_has_vertex_values(const std::filesystem::path& path) {
  const MeshFormat* format = mesh_format(path);
  if (format != nullptr && format->read_values != nullptr) return {};
  return usage(path, " is not that of a mesh with values at its vertices: " +
                         extensions([](const MeshFormat& f) { return f.read_values != nullptr; }));
}

Result<MeshWithValues> read_vertex_values(const std::filesystem::path& path,
                                          const std::string& array) {
  if (auto ok = check_has_vertex_values(path); !ok) return tl::unexpected(ok.error());
  return with_memory<MeshWithValues>(path, [&]() -> Result<MeshWithValues> {
    auto read = mesh_format(path)->read_values(path, array);
    if (!read) return tl::unexpected(read.error());
    if (read->mesh.triangles.empty())
      return fail(ExitCode::kUnreadableInput, path.string() + ": has no triangles");
    NamedArray& only = read->arrays.front();
    auto values = checked(path, only.name, std::move(only.values), read->mesh);
    if (!values) return tl::unexpected(values.error());
    return MeshWithValues{std::move(read->mesh), std::move(*values)};
  });
}

Result<MeshWithArrays> read_mesh_with_arrays(const DataPath& path) {
  const MeshFormat* format = mesh_format(path);
  if (format == nullptr || format->read_values == nullptr) {
    auto mesh = read_mesh(path);
    if (!mesh) return tl::unexpected(mesh.error());
    return MeshWithArrays{std::move(*mesh), {}};
  }
  return with_memory<MeshWithArrays>(path, [&] {
    auto read = format->read_values(path, std::nullopt);
    if (!read) return read;
    for (NamedArray& array : read->arrays)
      array.values = checked(path, array.name, std::move(array.values), read->mesh);
    return read;
  });
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
  for (std::size_t i = 0; i < mesh.faces.size(); ++i)
    for (const std::uint32_t corner : mesh.faces.of(i))
      if (corner >= vertices)
        return refuse("face " + std::to_string(i) + " of more than three corners has vertex " +
                      std::to_string(corner) + " of " + std::to_string(vertices));
  for (std::size_t i = 0; i < mesh.edges.size(); ++i)
    if (mesh.edges[i] >= vertices)
      return refuse("edge " + std::to_string(i / 2) + " has vertex " +
                    std::to_string(mesh.edges[i]) + " of " + std::to_string(vertices));
  if (const std::string fault = take_out_middles(path.string(), mesh); !fault.empty())
    return refuse(fault);
  cut_faces(mesh);
  if (!mesh.parts.empty() && mesh.parts.size() != mesh.triangles.size() / 3)
    return refuse("has parts of " + std::to_string(mesh.parts.size()) + " triangles, not of " +
                  std::to_string(mesh.triangles.size() / 3));
  for (std::size_t i = 0; i < mesh.parts.size(); ++i)
    if (mesh.parts[i] < 0)
      return refuse("triangle " + std::to_string(i) + " has the part " +
                    std::to_string(mesh.parts[i]) + ", they count from 0");
  if (!mesh.edge_bulges.empty() && mesh.edge_bulges.size() != mesh.edges.size() / 2)
    return refuse("has bulges of " + std::to_string(mesh.edge_bulges.size()) + " edges, not of " +
                  std::to_string(mesh.edges.size() / 2));
  for (std::size_t i = 0; i < mesh.edge_bulges.size(); ++i)
    if (!(std::fabs(mesh.edge_bulges[i]) <= 1))
      return refuse("edge " + std::to_string(i) +
                    " is no chord of an arc of at most half a circle");
  mesh.regions.resize(mesh.triangles.size() / 3);
  mesh.edge_markers.resize(mesh.edges.size() / 2);
  return mesh;
}

}  // namespace weft::files

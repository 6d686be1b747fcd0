// SPDX-License-Identifier: Apache-2.0
// The client's readers: the first byte chooses a format, the rest is the file, or up to three files
// that are read together. Asserts, beyond that a reader neither crashes nor takes memory out of
// proportion:
//   mesh     numbers of vertices are in range, coordinates finite, regions and markers complete
//   values   those at the vertices are as many, and none is infinite
//   domain   segments and seeds are what the server can take: indices in range, numbers finite
//   error    an error has a sentence
//   rewrite  what was read as a mesh is written as .npz, and read from there is the same
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "files/formats/domain_formats.h"
#include "files/formats/domains/seeded.h"
#include "files/formats/mesh_formats.h"
#include "files/formats/raster.h"
#include "tests/files/support/temp_folder.h"
#include "tests/fuzz/byte_source.h"
#include "tests/fuzz/law.h"

namespace weft::fuzz {
namespace {

using namespace files;

enum class Kind { kDomain, kMesh, kGrid };

struct Format {
  Kind kind;
  std::vector<std::string_view> extensions;  // of the files that are read together; the named first
};

const std::vector<Format>& formats() {
  static const std::vector<Format> all = {
      {Kind::kDomain, {".poly", ".node"}},
      {Kind::kDomain, {".geojson"}},
      {Kind::kDomain, {".wkt"}},
      {Kind::kDomain, {".csv"}},
      {Kind::kDomain, {".shp", ".shx", ".dbf"}},
      {Kind::kMesh, {".node", ".ele", ".poly"}},
      {Kind::kMesh, {".msh"}},
      {Kind::kMesh, {".14"}},
      {Kind::kMesh, {".su2"}},
      {Kind::kMesh, {".vtu"}},
      {Kind::kMesh, {".npz"}},
      {Kind::kMesh, {".obj"}},
      {Kind::kMesh, {".off"}},
      {Kind::kGrid, {".asc"}},
      {Kind::kMesh, {".2dm"}},
      {Kind::kMesh, {".nc"}},
      {Kind::kMesh, {".mesh"}},
      {Kind::kMesh, {".vol"}},
      {Kind::kMesh, {".mfem"}},
      {Kind::kDomain, {".dxf"}},
      {Kind::kDomain, {".in2d"}},
      {Kind::kDomain, {".fem"}},
      {Kind::kMesh, {".inp"}},
      {Kind::kDomain, {".zip"}},
  };
  return all;
}

// In memory where there is such a file system.
const TempFolder& folder() {
  static const std::filesystem::path memory = "/dev/shm";
  static const TempFolder folder(
      std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path());
  return folder;
}

// What does not hold of a mesh that was read, or "".
std::string wrong_with(const Mesh& mesh) {
  if (mesh.coordinates.size() % 2 != 0) return "half a vertex";
  const std::size_t vertices = mesh.coordinates.size() / 2;
  for (const double c : mesh.coordinates)
    if (!std::isfinite(c)) return "a coordinate that is not finite";
  if (mesh.triangles.size() % 3 != 0 || mesh.edges.size() % 2 != 0) return "a torn element";
  for (const std::uint32_t v : mesh.triangles)
    if (v >= vertices) return "a triangle of no vertex";
  for (const std::uint32_t v : mesh.edges)
    if (v >= vertices) return "an edge of no vertex";
  if (mesh.regions.size() != mesh.triangles.size() / 3) return "regions are missing";
  if (mesh.edge_markers.size() != mesh.edges.size() / 2) return "markers are missing";
  return "";
}

std::string wrong_with(const Domain& domain) {
  const auto finite = [](files::Point p) { return std::isfinite(p.x) && std::isfinite(p.y); };
  for (const files::Point p : domain.points)
    if (!finite(p)) return "a point that is not finite";
  for (const Domain::Segment& s : domain.segments)
    if (s.a >= domain.points.size() || s.b >= domain.points.size()) return "a segment of no point";
  for (const files::Point p : domain.holes)
    if (!finite(p)) return "a hole that is not finite";
  for (const Domain::Region& r : domain.regions)
    if (!finite(r.at) || (r.max_area && !(*r.max_area > 0))) return "a region that is no region";
  if (!domain.point_markers.empty() && domain.point_markers.size() != domain.points.size())
    return "markers of points are missing";
  for (std::size_t i = 0; i < domain.arcs.size(); ++i)
    if (domain.arcs[i].segment >= domain.segments.size() ||
        (i > 0 && domain.arcs[i].segment <= domain.arcs[i - 1].segment) ||
        !(std::abs(domain.arcs[i].bulge) <= 1e6))
      return "an arc that is no arc";
  for (std::size_t i = 0; i < domain.segments.size(); ++i) (void)domain.segment_places.locate(i);
  return "";
}

std::string rewritten(Mesh mesh) {
  mesh.warnings.clear();  // about the first file, as are the next two
  mesh.nodes.clear();
  mesh.cut_faces = 0;
  const std::filesystem::path path = folder() / "again.npz";
  std::vector<OutputFile> files;
  auto file = OutputFile::create(path, {});
  if (!file) return "";  // the disk's fault
  files.push_back(std::move(*file));
  write_mesh(*mesh_format(path), mesh.view(), files);
  if (!commit(files)) return "";
  const auto again = read_mesh(path);
  if (!again) return again.error().message;
  return *again == mesh ? "" : "the mesh is another one";
}

void judge(const std::uint8_t* data, std::size_t size) {
  ByteSource bytes(data, size);
  const Format& format = formats()[bytes.below(formats().size())];
  std::vector<std::filesystem::path> paths;
  std::vector<std::size_t> lengths;
  for (std::size_t i = 1; i < format.extensions.size(); ++i) lengths.push_back(bytes.two_bytes());
  for (std::size_t i = 0; i < format.extensions.size(); ++i) {
    const std::string_view content = i < lengths.size() ? bytes.take(lengths[i]) : bytes.rest();
    paths.push_back(folder() / ("in" + std::string(format.extensions[i])));
    if (i > 0 && content.empty())
      std::filesystem::remove(paths.back());
    else
      std::ofstream(paths.back(), std::ios::binary) << content;
  }
  const auto must = [&](bool holds, std::string_view law, const std::string& evidence) {
    if (!holds) broken(law, std::string(format.extensions[0]) + ": " + evidence, data, size);
  };
  const auto must_be_sound = [&](const auto& read, std::string_view law) {
    if (!read) return must(!read.error().message.empty(), "error", "no sentence");
    const std::string wrong = wrong_with(*read);
    must(wrong.empty(), law, wrong);
  };

  if (format.kind == Kind::kGrid) {
    const auto grid = read_raster(paths[0]);
    if (!grid) return must(!grid.error().message.empty(), "error", "no sentence");
    must(grid->values.size() == std::size_t{grid->columns} * grid->rows, "grid", "values");
    for (const double v : grid->values) must(std::isfinite(v) && v > 0, "grid", "a value");
    return;
  }
  if (format.kind == Kind::kMesh) {
    const auto mesh = read_mesh(paths[0]);
    must_be_sound(mesh, "mesh");
    if (mesh) {
      const std::string wrong = rewritten(*mesh);
      must(wrong.empty(), "rewrite", wrong);
    }
    for (const char* const array : {"", "h"}) {
      const auto values = read_vertex_values(paths[0], array);
      if (!values) {
        must(!values.error().message.empty(), "error", "no sentence");
        continue;
      }
      const std::string wrong = wrong_with(values->mesh);
      must(wrong.empty(), "mesh", wrong);
      must(values->values.size() == values->mesh.coordinates.size() / 2, "values", "their count");
      for (const double v : values->values) must(!std::isinf(v), "values", "an infinite one");
    }
  }
  const bool is_archive = paths[0].extension() == ".zip";  // GDAL reads them, too
  const auto domain = is_archive ? read_own_domain(paths[0]) : read_domain(paths[0]);
  must_be_sound(domain, "domain");
  if (domain) must_be_sound(seeded(*domain), "domain");
}

}  // namespace
}  // namespace weft::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  weft::fuzz::judge(data, size);
  return 0;
}

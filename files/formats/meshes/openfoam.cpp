// SPDX-License-Identifier: Apache-2.0
#include "files/formats/meshes/openfoam.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "files/bytes/text_writer.h"
#include "files/formats/derived/label_groups.h"
#include "files/formats/derived/mesh_edges.h"
#include "files/formats/format_names.h"

namespace weft::files {
namespace {

struct Part {
  const char* name;
  const char* type;
};
constexpr Part kParts[] = {{"points", "vectorField"},        {"faces", "faceList"},
                           {"owner", "labelList"},           {"neighbour", "labelList"},
                           {"boundary", "polyBoundaryMesh"}, {"cellZones", "regIOobject"}};

double thickness_of(const MeshView& mesh) {
  double twice = 0;
  const auto at = [&mesh](std::size_t corner) {
    return &mesh.coordinates[2 * std::size_t{mesh.triangles[corner]}];
  };
  for (const std::size_t t : mesh.up_to(mesh.triangle_count())) {
    const double* a = at(3 * t);
    const double* b = at(3 * t + 1);
    const double* c = at(3 * t + 2);
    twice += std::abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
  }
  return twice > 0 ? std::sqrt(twice / 2 / static_cast<double>(mesh.triangle_count())) : 1;
}

class Writer {
 public:
  Writer(const MeshView& mesh, std::span<OutputFile> files)
      : mesh_(mesh),
        points_(files[1]),
        faces_(files[2]),
        owner_(files[3]),
        neighbour_(files[4]),
        boundary_(files[5]),
        zones_(files[6]),
        edges_(mesh),
        opposite_(opposite_sides(mesh, edges_)),
        side_of_edge_(first_sides(mesh, edges_)),
        markers_(edge_markers(mesh, edges_)),
        patches_(mesh.pages, markers_.values(),
                 [this](std::size_t e) { return edges_.on_boundary(e); }),
        regions_(mesh.pages, mesh.regions, [](std::size_t) { return true; }) {
    for (std::size_t i = 0; i < std::size(kParts); ++i)
      files[i + 1].put(std::string("FoamFile\n{\n  version 2.0;\n  format ascii;\n  class ") +
                       kParts[i].type + ";\n  location \"constant/polyMesh\";\n  object " +
                       kParts[i].name + ";\n}\n\n");
  }

  void write() {
    put_points();
    put_faces();
    put_boundary();
    put_zones();
  }

 private:
  void put_points() {
    put_line(points_, 2 * mesh_.vertex_count());
    points_.put("(\n");
    for (const double z : {0.0, thickness_of(mesh_)})
      for (const std::size_t v : mesh_.up_to(mesh_.vertex_count())) {
        points_.put('(');
        points_.number(mesh_.coordinates[2 * v]);
        points_.put(' ');
        points_.number(mesh_.coordinates[2 * v + 1]);
        points_.put(' ');
        points_.number(z);
        points_.put(")\n");
      }
    points_.put(")\n");
  }

  // A face, directed outwards from its owner.
  template <std::size_t corners>
  void put_face(const std::array<std::uint64_t, corners>& face, std::size_t owner) {
    faces_.number(static_cast<std::int64_t>(corners));
    char before = '(';
    for (const std::uint64_t corner : face) {
      faces_.put(before);
      faces_.number(static_cast<std::int64_t>(corner));
      before = ' ';
    }
    faces_.put(")\n");
    put_line(owner_, owner);
  }
  std::uint64_t top(std::uint64_t vertex) const { return vertex + mesh_.vertex_count(); }
  void put_wall(std::size_t side) {
    const std::uint64_t a = mesh_.triangles[side];
    const std::uint64_t b = mesh_.triangles[side % 3 == 2 ? side - 2 : side + 1];
    put_face<4>({a, b, top(b), top(a)}, side / 3);
  }

  // The faces inside are sorted by owner, then by neighbour, as OpenFOAM wants them.
  void put_faces() {
    const std::size_t triangles = mesh_.triangle_count();
    for (const std::size_t side : mesh_.up_to(3 * triangles))
      inside_ += opposite_[side] != kNoSide && opposite_[side] > side ? 1 : 0;
    const std::size_t all = inside_ + patches_.size() + 2 * triangles;
    for (auto [file, count] : {std::pair{&faces_, all}, {&owner_, all}, {&neighbour_, inside_}}) {
      put_line(*file, count);
      file->put("(\n");
    }
    for (const std::size_t t : mesh_.up_to(triangles)) {
      std::array<std::array<std::uint32_t, 2>, 3> next;  // neighbour and side
      std::size_t count = 0;
      for (std::uint32_t side = 3 * static_cast<std::uint32_t>(t); side < 3 * t + 3; ++side)
        if (opposite_[side] != kNoSide && opposite_[side] > side)
          next[count++] = {opposite_[side] / 3, side};
      std::sort(next.begin(), next.begin() + count);
      for (std::size_t i = 0; i < count; ++i) {
        put_wall(next[i][1]);
        put_line(neighbour_, next[i][0]);
      }
    }
    for (const std::size_t i : mesh_.up_to(patches_.size())) put_wall(side_of_edge_[patches_[i]]);
    for (const std::size_t t : mesh_.up_to(triangles))
      put_face<3>({mesh_.triangles[3 * t], mesh_.triangles[3 * t + 2], mesh_.triangles[3 * t + 1]},
                  t);
    for (const std::size_t t : mesh_.up_to(triangles))
      put_face<3>({top(mesh_.triangles[3 * t]), top(mesh_.triangles[3 * t + 1]),
                   top(mesh_.triangles[3 * t + 2])},
                  t);
    for (OutputFile* file : {&faces_, &owner_, &neighbour_}) file->put(")\n");
  }

  // The name of a label, or else a word such as "marker_2".
  std::string word_for(NameKind kind, std::int32_t label) const {
    const std::string* const name = name_of(mesh_.names->table(kind), label);
    return name != nullptr ? *name : std::string(word_of(kind)) + "_" + std::to_string(label);
  }
  void put_patch(const std::string& name, const char* type, std::size_t first, std::size_t count) {
    boundary_.put("  " + name + "\n  {\n    type " + type + ";\n    nFaces " +
                  std::to_string(count) + ";\n    startFace " + std::to_string(first) + ";\n  }\n");
  }
  void put_boundary() {
    put_line(boundary_, patches_.all().size() + 1);
    boundary_.put("(\n");
    for (const auto& [marker, first, count] : patches_.all())
      put_patch(word_for(NameKind::kMarker, marker), "patch", inside_ + first, count);
    put_patch(kFrontAndBack, "empty", inside_ + patches_.size(), 2 * mesh_.triangle_count());
    boundary_.put(")\n");
  }

  void put_zones() {
    put_line(zones_, regions_.all().size());
    zones_.put("(\n");
    for (const auto& [region, first, count] : regions_.all()) {
      zones_.put("  " + word_for(NameKind::kRegion, region) +
                 "\n  {\n    type cellZone;\n    cellLabels List<label>\n" + std::to_string(count) +
                 "\n(\n");
      for (const std::size_t i : mesh_.up_to(count)) put_line(zones_, regions_[first + i]);
      zones_.put(")\n;\n  }\n");
    }
    zones_.put(")\n");
  }

  const MeshView& mesh_;
  OutputFile& points_;
  OutputFile& faces_;
  OutputFile& owner_;
  OutputFile& neighbour_;
  OutputFile& boundary_;
  OutputFile& zones_;
  MeshEdges edges_;
  ScratchArray<std::uint32_t> opposite_;
  ScratchArray<std::uint32_t> side_of_edge_;
  ScratchArray<std::int32_t> markers_;  // of all edges
  LabelGroups patches_;                 // edges of the boundary by marker
  LabelGroups regions_;                 // triangles by region
  std::size_t inside_ = 0;              // faces between two cells
};

}  // namespace

std::vector<std::filesystem::path> openfoam_files(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> files = {path};
  for (const Part& part : kParts)
    files.push_back(path.parent_path() / "constant" / "polyMesh" / part.name);
  return files;
}

void write_openfoam(const MeshView& mesh, std::span<OutputFile> files) {
  Writer(mesh, files).write();
}

}  // namespace weft::files

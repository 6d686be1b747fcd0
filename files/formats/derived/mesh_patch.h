// SPDX-License-Identifier: Apache-2.0
// A part of a mesh that is meshed anew, while the rest stays as it is.
//
//   auto patch = cut_patch("old.vtu", old, triangles_within(old.view(), polygon));
//   ... patch->domain is meshed, and nothing is put on segments with the marker patch->outline ...
//   auto mesh = put_back(old, *patch, made, [](Point p) { return p; });
//
// Errors: kUsage if no triangle is within, or all are; kUnreadableInput if two vertices of the
// outline are at one place, or the outline did not stay. REQUIRES: vertex numbers are in range.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "files/base/error.h"
#include "files/formats/domain.h"
#include "files/formats/mesh.h"

namespace weft::files {

// Per triangle: whether all of its corners are in the polygons, by even-odd filling of their
// segments.
std::vector<bool> triangles_within(const MeshView& mesh, const Domain& polygons);

struct MeshPatch {
  Domain domain;                          // that of the triangles within (mesh_domain.h)
  std::int32_t outline = 0;               // marker of the segments between the patch and the rest
  std::vector<bool> within{};             // per triangle of the mesh
  std::vector<std::uint32_t> vertices{};  // of the mesh: per point of the domain
  std::size_t sides = 0;                  // of the outline
};

Result<MeshPatch> cut_patch(const std::string& name, const Mesh& mesh, std::vector<bool> within);

struct PatchedMesh {
  // Vertices of the rest keep their order, and their numbers unless the patch has fewer vertices
  // than before; new ones take the numbers that are free, then those at the end. Triangles and
  // edges of the rest come first.
  Mesh mesh;
  // Per vertex: that of the old mesh, kNew for one that `made` brought.
  static constexpr std::uint32_t kNew = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> old_vertex;

  // Values at the vertices, of those at the old ones: linear in the old triangles within at new
  // ones, at places outside of them as at the nearest corner of one.
  std::vector<double> carried(const Mesh& old, const MeshPatch& patch,
                              const std::vector<double>& values) const;
};

// `place` is where a vertex of `made` lies in the coordinates of the mesh. REQUIRES: `made` is a
// mesh of patch.domain, and lists its input points and edges.
Result<PatchedMesh> put_back(const Mesh& mesh, const MeshPatch& patch, const MeshView& made,
                             const std::function<Point(Point)>& place);

}  // namespace weft::files

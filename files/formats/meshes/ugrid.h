// SPDX-License-Identifier: Apache-2.0
// UGRID 1.0, the conventions of unstructured grids in NetCDF (https://ugrid-conventions.github.io),
// as Delft3D-FM, SCHISM's tools, QGIS and xugrid read them: the mesh `mesh2d` with its nodes, all
// edges and its triangles, counted from 0, the names as Deltares has them:
//   mesh2d_node_x, mesh2d_node_y       longitude and latitude if the mesh is in degrees
//   mesh2d_edge_nodes                  all edges, those on input segments or not
//   mesh2d_face_nodes
//   mesh2d_edge_marker                 of the edges on input segments; 0 for others
//   mesh2d_region, mesh2d_part         of the triangles; the part if the mesh is divided
//   mesh2d_node_z                      the elevation of the bed, positive up, if it is known
//   mesh2d_NAME                        every value at the nodes
//
// Names of markers and regions are flag_values and flag_meanings (CF conventions, 3.5) of
// mesh2d_edge_marker and mesh2d_region.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "files/base/atomic_file.h"
#include "files/base/error.h"
#include "files/formats/derived/vertex_values.h"
#include "files/formats/mesh.h"

namespace weft::files {

void write_ugrid(const MeshView& mesh, OutputFile& file);

// Reads the first two-dimensional mesh of a UGRID file in NetCDF's classic format, whose
// faces may have more than three nodes; regions and markers by the names above, after that of the
// mesh. Its edges are those with a marker that is not 0.
Result<Mesh> read_ugrid(const std::filesystem::path& path);

// The same with the values at its nodes, by their names without that of the mesh; node_z is the
// array "elevation", or "depth" if it is positive down.
Result<MeshWithArrays> read_ugrid_values(const std::filesystem::path& path,
                                         const std::optional<std::string>& wanted);

}  // namespace weft::files

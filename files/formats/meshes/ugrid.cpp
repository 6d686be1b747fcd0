// SPDX-License-Identifier: Apache-2.0
#include "files/formats/meshes/ugrid.h"

#include <string>
#include <vector>

#include "files/bytes/big_endian.h"
#include "files/bytes/netcdf_header.h"
#include "files/formats/bed.h"
#include "files/formats/derived/mesh_edges.h"

namespace weft::files {
namespace {

constexpr auto kInt = NetcdfType::kInt;
constexpr auto kDouble = NetcdfType::kDouble;

void describe_coordinates(NetcdfHeader& header, CoordinateUnit unit, std::size_t nodes) {
  struct Axis {
    const char* name;
    const char* in_degrees;
    const char* in_plane;
    const char* degrees;
  };
  for (const Axis& axis :
       {Axis{"mesh2d_node_x", "longitude", "projection_x_coordinate", "degrees_east"},
        Axis{"mesh2d_node_y", "latitude", "projection_y_coordinate", "degrees_north"}}) {
    const bool degrees = unit == CoordinateUnit::kDegrees;
    auto& attributes = header.variable(axis.name, kDouble, {nodes})
                           .text("standard_name", degrees ? axis.in_degrees : axis.in_plane)
                           .text("mesh", "mesh2d")
                           .text("location", "node");
    if (unit != CoordinateUnit::kUnknown) attributes.text("units", degrees ? axis.degrees : "m");
  }
}

NetcdfHeader::Attributes& add_values(NetcdfHeader& header, const std::string& name, NetcdfType type,
                                     std::size_t dimension, const char* location) {
  return header.variable("mesh2d_" + name, type, {dimension})
      .text("mesh", "mesh2d")
      .text("location", location)
      .text("coordinates", std::string("mesh2d_") + location + "_x mesh2d_" + location + "_y");
}

// What values mean (CF conventions, 3.5).
void add_flags(NetcdfHeader::Attributes& attributes, const NameTable& names) {
  if (names.empty()) return;
  std::vector<std::int32_t> values;
  std::string meanings;
  for (const auto& [id, name] : names) {
    values.push_back(id);
    meanings += (meanings.empty() ? "" : " ") + name;
  }
  attributes.numbers("flag_values", values).text("flag_meanings", meanings);
}

NetcdfHeader header_of(const MeshView& mesh, std::size_t edge_count, const Bed& bed) {
  NetcdfHeader header;
  header.file()
      .text("Conventions", "CF-1.8 UGRID-1.0 Deltares-0.10")
      .text("title", "Triangle mesh")
      .text("source", "weft");
  const std::size_t nodes = header.dimension("mesh2d_nNodes", mesh.vertex_count());
  const std::size_t edges = header.dimension("mesh2d_nEdges", edge_count);
  const std::size_t faces = header.dimension("mesh2d_nFaces", mesh.triangle_count());
  const std::size_t three = header.dimension("mesh2d_nMax_face_nodes", 3);
  const std::size_t two = header.dimension("Two", 2);
  header.variable("mesh2d", kInt, {})
      .text("cf_role", "mesh_topology")
      .text("long_name", "Topology of the triangle mesh")
      .number("topology_dimension", 2)
      .text("node_coordinates", "mesh2d_node_x mesh2d_node_y")
      .text("node_dimension", "mesh2d_nNodes")
      .text("edge_node_connectivity", "mesh2d_edge_nodes")
      .text("edge_dimension", "mesh2d_nEdges")
      .text("face_node_connectivity", "mesh2d_face_nodes")
      .text("face_dimension", "mesh2d_nFaces")
      .text("max_face_nodes_dimension", "mesh2d_nMax_face_nodes");
  describe_coordinates(header, mesh.unit, nodes);
  header.variable("mesh2d_edge_nodes", kInt, {edges, two})
      .text("cf_role", "edge_node_connectivity")
      .number("start_index", 0);
  header.variable("mesh2d_face_nodes", kInt, {faces, three})
      .text("cf_role", "face_node_connectivity")
      .number("start_index", 0)
      .number("_FillValue", -1);
  const auto add = [&header](const char* name, std::size_t dimension, const char* location,
                             const char* about) -> auto& {
    return header.variable(std::string("mesh2d_") + name, kInt, {dimension})
        .text("mesh", "mesh2d")
        .text("location", location)
        .text("long_name", about);
  };
  add_flags(add("edge_marker", edges, "edge", "Marker of the input segment on which the edge lies"),
            mesh.names->markers);
  add_flags(add("region", faces, "face", "Region of the triangle"), mesh.names->regions);
  if (!mesh.parts.empty()) add("part", faces, "face", "Part of the mesh, from 0");
  if (bed.is_known())
    add_values(header, "node_z", kDouble, nodes, "node")
        .text("standard_name", "altitude")
        .text("long_name", "Elevation of the bed")
        .text("units", "m")
        .text("positive", "up");
  for (const VertexValues& values : mesh.vertex_values) {
    auto& attributes =
        add_values(header, values.name, kDouble, nodes, "node").text("long_name", values.name);
    if (Bed::is_bed(values.name))
      attributes.text("units", "m").text("positive", values.name == "depth" ? "down" : "up");
  }
  return header;
}

template <class T>
void put_values(OutputFile& file, const MeshView& mesh, std::span<const T> values) {
  for (const std::size_t i : mesh.up_to(values.size())) put_big_endian(file, values[i]);
}

}  // namespace

void write_ugrid(const MeshView& mesh, OutputFile& file) {
  const MeshEdges edges(mesh);
  const Bed bed(mesh);
  header_of(mesh, edges.size(), bed).put(file);
  put_big_endian(file, std::int32_t{0});  // mesh2d, which has attributes alone
  for (const std::size_t axis : {0, 1})
    for (const std::size_t v : mesh.up_to(mesh.vertex_count()))
      put_big_endian(file, mesh.coordinates[2 * v + axis]);
  for (const std::size_t e : mesh.up_to(edges.size())) {
    put_big_endian(file, edges.low(e));
    put_big_endian(file, edges.high(e));
  }
  put_values(file, mesh, mesh.triangles);
  put_values(file, mesh, edge_markers(mesh, edges).values());
  put_values(file, mesh, mesh.regions);
  put_values(file, mesh, mesh.parts);
  if (bed.is_known())
    for (const std::size_t v : mesh.up_to(mesh.vertex_count()))
      put_big_endian(file, bed.elevation(v));
  for (const VertexValues& values : mesh.vertex_values) put_values(file, mesh, values.values);
}

}  // namespace weft::files

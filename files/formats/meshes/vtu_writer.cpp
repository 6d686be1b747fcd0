// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "files/formats/meshes/array_writer.h"
#include "files/formats/meshes/vtu.h"

namespace weft::files {
namespace {

// VTK's numbers of the kinds of cells, of order 1 and 2.
constexpr std::uint8_t kLine[] = {3, 21};
constexpr std::uint8_t kTriangle[] = {5, 22};
constexpr std::size_t kBlock = 1 << 14;  // values that are converted at a time

// A text as an attribute of XML. It has no control characters.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

// One array for each name: its id, and the dimension of what has it.
std::string field_data(const Names& names) {
  if (names.empty()) return "";
  std::string text = "<FieldData>\n";
  const auto add = [&text](const NameTable& table, const char* dimension) {
    for (const auto& [id, name] : table)
      text += "<DataArray type=\"Int32\" Name=\"" + escaped(name) +
              "\" NumberOfTuples=\"2\" format=\"ascii\">" + std::to_string(id) + dimension +
              "</DataArray>\n";
  };
  add(names.markers, " 1");
  add(names.regions, " 2");
  return text + "</FieldData>\n";
}

// One array of the appended section: its element and its place.
struct Section {
  std::string tag;
  std::uint64_t bytes;
};

void put_points(OutputFile& file, const MeshView& mesh) {
  std::vector<double> block;
  block.reserve(3 * kBlock);
  for (const std::size_t v : mesh.up_to(mesh.vertex_count())) {
    block.insert(block.end(), {mesh.coordinates[2 * v], mesh.coordinates[2 * v + 1], 0.0});
    if (block.size() == 3 * kBlock) {
      file.put_array(std::span<const double>(block));
      block.clear();
    }
  }
  file.put_array(std::span<const double>(block));
}

// The place in the connectivity where each cell ends: triangles first.
void put_offsets(OutputFile& file, const MeshView& mesh) {
  const std::size_t triangles = mesh.triangle_count();
  const std::size_t cells = triangles + mesh.edge_count();
  std::vector<std::int64_t> block;
  block.reserve(kBlock);
  std::int64_t end = 0;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    end += static_cast<std::int64_t>(cell < triangles ? mesh.triangle_nodes() : mesh.edge_nodes());
    block.push_back(end);
    if (block.size() == kBlock) {
      file.put_array(std::span<const std::int64_t>(block));
      block.clear();
    }
  }
  file.put_array(std::span<const std::int64_t>(block));
}

}  // namespace

void write_vtu(const MeshView& mesh, OutputFile& file) {
  const std::size_t triangles = mesh.triangle_count();
  const std::size_t edges = mesh.edge_count();
  const std::size_t cells = triangles + edges;
  std::vector<Section> sections = {
      {"<Points><DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"",
       mesh.vertex_count() * 3 * sizeof(double)},
      {"</Points><Cells><DataArray type=\"UInt32\" Name=\"connectivity\"",
       mesh.triangles.size_bytes() + mesh.edges.size_bytes()},
      {"<DataArray type=\"Int64\" Name=\"offsets\"", cells * sizeof(std::int64_t)},
      {"<DataArray type=\"UInt8\" Name=\"types\"", cells},
      {"</Cells><CellData><DataArray type=\"Int32\" Name=\"region\"", cells * sizeof(std::int32_t)},
      {"<DataArray type=\"Int32\" Name=\"marker\"", cells * sizeof(std::int32_t)},
  };
  if (!mesh.parts.empty())
    sections.push_back({"<DataArray type=\"Int32\" Name=\"part\"", cells * sizeof(std::int32_t)});
  std::string before = "</CellData><PointData>";
  for (const VertexValues& values : mesh.vertex_values)
    sections.push_back(
        {std::exchange(before, "") + "<DataArray type=\"Float64\" Name=\"" + values.name + "\"",
         values.values.size_bytes()});
  std::string header =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n"
      "<UnstructuredGrid>" +
      field_data(*mesh.names) + "<Piece NumberOfPoints=\"" + std::to_string(mesh.vertex_count()) +
      "\" NumberOfCells=\"" + std::to_string(cells) + "\">\n";
  std::uint64_t offset = 0;
  for (const Section& section : sections) {
    header += section.tag;
    header += " format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>\n";
    offset += sizeof(std::uint64_t) + section.bytes;
  }
  header += mesh.vertex_values.empty() ? "</CellData>" : "</PointData>";
  header += "</Piece></UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
  file.put(header);

  auto section = sections.begin();
  file.put_raw((section++)->bytes);
  put_points(file, mesh);
  file.put_raw((section++)->bytes);
  put_values(file, mesh, mesh.triangles);
  put_values(file, mesh, mesh.edges);
  file.put_raw((section++)->bytes);
  put_offsets(file, mesh);
  file.put_raw((section++)->bytes);
  put_equal(file, kTriangle[mesh.order - 1], triangles);
  put_equal(file, kLine[mesh.order - 1], edges);
  file.put_raw((section++)->bytes);
  put_values(file, mesh, mesh.regions);
  put_equal(file, std::int32_t{0}, edges);
  file.put_raw((section++)->bytes);
  put_equal(file, std::int32_t{0}, triangles);
  put_values(file, mesh, mesh.edge_markers);
  if (!mesh.parts.empty()) {
    file.put_raw((section++)->bytes);
    put_values(file, mesh, mesh.parts);
    put_equal(file, std::int32_t{-1}, edges);
  }
  for (const VertexValues& values : mesh.vertex_values) {
    file.put_raw((section++)->bytes);
    put_values(file, mesh, values.values);
  }
  file.put("\n</AppendedData>\n</VTKFile>\n");
}

}  // namespace weft::files

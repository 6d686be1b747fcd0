// SPDX-License-Identifier: Apache-2.0
#include "files/formats/meshes/xdmf.h"

#include <cstdint>
#include <string>
#include <string_view>

#include "files/formats/meshes/array_writer.h"

namespace weft::files {
namespace {

// XDMF's numbers of the kinds of cells. A line of order 1 is a polyline, which is followed by its
// number of nodes.
constexpr std::uint32_t kTriangle[] = {4, 36};
constexpr std::uint32_t kPolyline = 2;
constexpr std::uint32_t kQuadraticLine = 34;

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text)
    out += c == '&'   ? "&amp;"
           : c == '<' ? "&lt;"
           : c == '>' ? "&gt;"
           : c == '"' ? "&quot;"
                      : std::string(1, c);
  return out;
}

// The XML, and the place of each array in the other file.
class Description {
 public:
  explicit Description(std::string arrays) : arrays_(escaped(arrays)) {}

  void open(const std::string& tag) { text_ += "<" + tag + ">"; }
  void close(const char* name) { text_ += std::string("</") + name + ">\n"; }
  // The arrays have the order that they have in the file.
  void array(const char* type, std::size_t precision, std::size_t rows, std::size_t columns = 1) {
    text_ += "<DataItem Dimensions=\"" + std::to_string(rows) +
             (columns > 1 ? " " + std::to_string(columns) : "") + "\" NumberType=\"" + type +
             "\" Precision=\"" + std::to_string(precision) +
             "\" Format=\"Binary\" Endian=\"Little\" Seek=\"" + std::to_string(offset_) + "\">" +
             arrays_ + "</DataItem>";
    offset_ += rows * columns * precision;
  }
  void attribute(const std::string& name, const char* center, const char* type,
                 std::size_t precision, std::size_t count) {
    open("Attribute Name=\"" + name + "\" AttributeType=\"Scalar\" Center=\"" + center + "\"");
    array(type, precision, count);
    close("Attribute");
  }
  void information(const std::string& name, const std::string& value) {
    text_ += "<Information Name=\"" + name + "\" Value=\"" + escaped(value) + "\"/>\n";
  }
  const std::string& text() const { return text_; }

 private:
  std::string arrays_;
  std::string text_;
  std::uint64_t offset_ = 0;
};

void put_topology(OutputFile& file, const MeshView& mesh) {
  const std::size_t corners = mesh.triangle_nodes();
  for (const std::size_t t : mesh.up_to(mesh.triangle_count())) {
    file.put_raw(kTriangle[mesh.order - 1]);
    file.put_array(mesh.triangles.subspan(corners * t, corners));
  }
  const std::size_t ends = mesh.edge_nodes();
  for (const std::size_t e : mesh.up_to(mesh.edge_count())) {
    file.put_raw(mesh.order == 1 ? kPolyline : kQuadraticLine);
    if (mesh.order == 1) file.put_raw(std::uint32_t{2});
    file.put_array(mesh.edges.subspan(ends * e, ends));
  }
}

}  // namespace

void write_xdmf(const MeshView& mesh, OutputFile& xml, OutputFile& arrays) {
  const std::size_t triangles = mesh.triangle_count();
  const std::size_t edges = mesh.edge_count();
  const std::size_t cells = triangles + edges;
  const std::size_t line = mesh.edge_nodes() + (mesh.order == 1 ? 2 : 1);

  Description about(arrays.target().filename().string());
  for (const NameKind kind : {NameKind::kMarker, NameKind::kRegion})
    for (const auto& [id, name] : mesh.names->table(kind))
      about.information(std::string(word_of(kind)) + " " + std::to_string(id), name);
  about.open("Topology TopologyType=\"Mixed\" NumberOfElements=\"" + std::to_string(cells) + "\"");
  about.array("UInt", 4, triangles * (mesh.triangle_nodes() + 1) + edges * line);
  about.close("Topology");
  about.open("Geometry GeometryType=\"XY\"");
  about.array("Float", 8, mesh.vertex_count(), 2);
  about.close("Geometry");
  about.attribute("region", "Cell", "Int", 4, cells);
  about.attribute("marker", "Cell", "Int", 4, cells);
  if (!mesh.parts.empty()) about.attribute("part", "Cell", "Int", 4, cells);
  for (const VertexValues& values : mesh.vertex_values)
    about.attribute(values.name, "Node", "Float", 8, values.values.size());
  xml.put(
      "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n"
      "<Grid Name=\"mesh\" GridType=\"Uniform\">\n");
  xml.put(about.text());
  xml.put("</Grid>\n</Domain>\n</Xdmf>\n");

  put_topology(arrays, mesh);
  put_values(arrays, mesh, mesh.coordinates);
  put_values(arrays, mesh, mesh.regions);
  put_equal(arrays, std::int32_t{0}, edges);
  put_equal(arrays, std::int32_t{0}, triangles);
  put_values(arrays, mesh, mesh.edge_markers);
  if (!mesh.parts.empty()) {
    put_values(arrays, mesh, mesh.parts);
    put_equal(arrays, std::int32_t{-1}, edges);
  }
  for (const VertexValues& values : mesh.vertex_values) put_values(arrays, mesh, values.values);
}

}  // namespace weft::files

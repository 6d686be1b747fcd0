// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "files/formats/derived/label_groups.h"
#include "files/formats/derived/mesh_edges.h"
#include "files/formats/derived/second_order.h"
#include "files/formats/meshes/inp.h"

namespace weft::files {
namespace {

constexpr std::ptrdiff_t kLongestNumber = 20;  // characters
constexpr std::size_t kMaxInLine = 16;

void put_real(OutputFile& file, double value) {
  std::array<char, 32> text;
  char* end = std::to_chars(text.begin(), text.end(), value).ptr;
  for (int digits = 17; end - text.begin() > kLongestNumber; --digits)
    end = std::to_chars(text.begin(), text.end(), value, std::chars_format::general, digits).ptr;
  file.put(std::string_view(text.begin(), end));
}

// Numbers from 0, as those from 1 that the file has.
class NumberLine {
 public:
  explicit NumberLine(OutputFile& file) : file_(file) {}
  void put(std::size_t number) {
    if (in_line_ == kMaxInLine) end();
    if (in_line_++ > 0) file_.put(", ");
    file_.number(static_cast<std::int64_t>(number) + 1);
  }
  void end() {
    file_.put('\n');
    in_line_ = 0;
  }

 private:
  OutputFile& file_;
  std::size_t in_line_ = 0;
};

class Writer {
 public:
  Writer(const MeshView& mesh, OutputFile& file)
      : mesh_(mesh),
        file_(file),
        edges_(CornerMesh(mesh).view()),
        side_of_edge_(first_sides(mesh, edges_)),
        regions_(mesh.pages, mesh.regions, [](std::size_t) { return true; }),
        markers_(mesh.pages, mesh.edge_markers,
                 [this](std::size_t e) { return side(e) != kNoSide; }) {}

  void write() {
    put_nodes();
    for (const auto& [region, first, count] : regions_.all()) {
      file_.put(mesh_.order == 2 ? "*ELEMENT, TYPE=CPS6, ELSET=" : "*ELEMENT, TYPE=CPS3, ELSET=");
      file_.put(word_for(NameKind::kRegion, region) + "\n");
      for (const std::size_t i : mesh_.up_to(count)) put_element(regions_[first + i]);
    }
    for (const LabelGroups::Group& marker : markers_.all()) {
      const std::string name = word_for(NameKind::kMarker, marker.label);
      file_.put("*NSET, NSET=" + name + "\n");
      put_nodes_of(marker);
      file_.put("*SURFACE, NAME=" + name + ", TYPE=ELEMENT\n");
      for (const std::size_t i : mesh_.up_to(marker.count)) {
        const std::uint32_t at = side(markers_[marker.first + i]);
        file_.number(std::int64_t{at / 3} + 1);
        file_.put(", S");
        file_.number(std::int64_t{at % 3} + 1);
        file_.put('\n');
      }
    }
  }

 private:
  std::uint32_t side(std::size_t e) const { return side_of_edge_[edges_.of_input_edge(e)]; }
  std::string word_for(NameKind kind, std::int32_t label) const {
    const std::string* const name = name_of(mesh_.names->table(kind), label);
    return name != nullptr ? *name : std::string(word_of(kind)) + "_" + std::to_string(label);
  }

  void put_nodes() {
    file_.put("*HEADING\nTriangle mesh of weft\n*NODE\n");
    for (const std::size_t v : mesh_.up_to(mesh_.vertex_count())) {
      file_.number(static_cast<std::int64_t>(v) + 1);
      for (const std::size_t axis : {0, 1}) {
        file_.put(", ");
        put_real(file_, mesh_.coordinates[2 * v + axis]);
      }
      file_.put('\n');
    }
  }
  void put_element(std::size_t t) {
    NumberLine line(file_);
    line.put(t);
    for (std::size_t k = 0; k < mesh_.triangle_nodes(); ++k)
      line.put(mesh_.triangles[mesh_.triangle_nodes() * t + k]);
    line.end();
  }
  void put_nodes_of(const LabelGroups::Group& marker) {
    std::vector<std::uint32_t> nodes;
    const std::size_t each = mesh_.edge_nodes();
    for (const std::size_t i : mesh_.up_to(marker.count))
      for (std::size_t k = 0; k < each; ++k)
        nodes.push_back(mesh_.edges[each * markers_[marker.first + i] + k]);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    NumberLine line(file_);
    for (const std::uint32_t node : nodes) line.put(node);
    line.end();
  }

  const MeshView& mesh_;
  OutputFile& file_;
  MeshEdges edges_;
  ScratchArray<std::uint32_t> side_of_edge_;
  LabelGroups regions_;  // triangles by region
  LabelGroups markers_;  // the mesh's own edges by marker
};

}  // namespace

void write_inp(const MeshView& mesh, OutputFile& file) {
  Writer(mesh, file).write();
}

}  // namespace weft::files

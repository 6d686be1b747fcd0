// SPDX-License-Identifier: Apache-2.0
#include "files/formats/meshes/exodus.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <limits>
#include <string>
#include <system_error>
#include <vector>

#include "files/bytes/big_endian.h"
#include "files/bytes/netcdf_header.h"
#include "files/formats/derived/label_groups.h"
#include "files/formats/derived/mesh_edges.h"
#include "files/formats/derived/second_order.h"

namespace weft::files {
namespace {

constexpr auto kChar = NetcdfType::kChar;
constexpr auto kInt = NetcdfType::kInt;
constexpr auto kDouble = NetcdfType::kDouble;
constexpr std::size_t kUsualNameLength = 32;  // the usual limit; longer names raise it

// What each group is called: by its name, or else "region 7".
std::vector<std::string> names_of(NameKind kind, const LabelGroups& groups, const Names& names) {
  std::vector<std::string> out;
  for (const auto& group : groups.all()) {
    const std::string* const name = name_of(names.table(kind), group.label);
    out.push_back(name != nullptr ? *name
                                  : std::string(word_of(kind)) + " " + std::to_string(group.label));
  }
  return out;
}

// The id of a group in the file.
std::int32_t id_of(const LabelGroups& groups, std::size_t group) {
  return groups.all().front().label > 0 ? groups.all()[group].label
                                        : static_cast<std::int32_t>(group) + 1;
}

class Writer {
 public:
  Writer(const MeshView& mesh, OutputFile& file)
      : mesh_(mesh),
        file_(file),
        edges_(CornerMesh(mesh).view()),
        side_of_edge_(first_sides(mesh, edges_)),
        blocks_(mesh.pages, mesh.regions, [](std::size_t) { return true; }),
        element_(mesh.pages, mesh.triangle_count()),
        sets_(mesh.pages, mesh.edge_markers, [this](std::size_t e) { return side(e) != kNoSide; }),
        block_names_(names_of(NameKind::kRegion, blocks_, *mesh.names)),
        set_names_(names_of(NameKind::kMarker, sets_, *mesh.names)) {
    for (const auto* names : {&block_names_, &set_names_})
      for (const std::string& name : *names) name_length_ = std::max(name_length_, name.size());
    Jumps jumps(mesh.pages);
    for (const std::size_t i : mesh.up_to(blocks_.size())) {
      jumps.to(blocks_[i]);
      element_[blocks_[i]] = static_cast<std::uint32_t>(i);
    }
  }

  void write() {
    describe();
    put(0.0);  // the time
    put_groups(blocks_, block_names_);
    for (std::size_t b = 0; b < blocks_.all().size(); ++b)
      each_of(blocks_, b, [this](std::size_t t) {
        const std::size_t nodes = mesh_.triangle_nodes();
        for (std::size_t k = 0; k < nodes; ++k) put(mesh_.triangles[nodes * t + k] + 1);
      });
    for (std::size_t b = 0; b < blocks_.all().size(); ++b)
      each_of(blocks_, b, [this](std::size_t t) { put(static_cast<std::uint32_t>(t) + 1); });
    for (const std::size_t axis : {0, 1})
      for (const std::size_t v : mesh_.up_to(mesh_.vertex_count()))
        put(mesh_.coordinates[2 * v + axis]);
    put_names({"x", "y"});
    put_groups(sets_, set_names_);
    for (std::size_t s = 0; s < sets_.all().size(); ++s) {
      each_of(sets_, s, [this](std::size_t e) { put(element_[side(e) / 3] + 1); });
      each_of(sets_, s, [this](std::size_t e) { put(side(e) % 3 + 1); });
    }
    put_results();
  }

 private:
  template <class T>
  void put(T value) {
    put_big_endian(file_, value);
  }
  // The side of a triangle that is edge e of the mesh.
  std::uint32_t side(std::size_t e) const { return side_of_edge_[edges_.of_input_edge(e)]; }

  template <class Act>
  void each_of(const LabelGroups& groups, std::size_t group, const Act& act) const {
    const auto& [label, first, count] = groups.all()[group];
    for (const std::size_t i : mesh_.up_to(count)) act(groups[first + i]);
  }
  void put_groups(const LabelGroups& groups, const std::vector<std::string>& names) {
    const std::size_t count = groups.all().size();
    for (std::size_t g = 0; g < count; ++g) put(std::int32_t{1});
    for (std::size_t g = 0; g < count; ++g) put(id_of(groups, g));
    put_names(names);
  }
  // Texts in rows, each with a zero at its end, and then the zeros that NetCDF wants.
  void put_names(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) {
      text += name;
      text.append(name_length_ + 1 - name.size(), '\0');
    }
    text.resize((text.size() + 3) / 4 * 4, '\0');
    file_.put(text);
  }

  // In the order in which `write` writes the arrays.
  void describe() {
    NetcdfHeader header;
    header.file()
        .text("title", "Triangle mesh of weft")
        .number("api_version", 5.22F)
        .number("version", 5.22F)
        .number("floating_point_word_size", std::int32_t{8})
        .number("file_size", std::int32_t{1})
        .number("maximum_name_length", static_cast<std::int32_t>(name_length_));
    const auto numbered = [](const char* name, std::size_t i) {
      return name + std::to_string(i + 1);
    };
    const std::size_t step = header.dimension("time_step", 1);
    const std::size_t name = header.dimension("len_name", name_length_ + 1);
    header.dimension("len_string", kUsualNameLength + 1);
    header.dimension("len_line", 81);
    header.dimension("four", 4);
    const std::size_t axes = header.dimension("num_dim", 2);
    const std::size_t nodes = header.dimension("num_nodes", mesh_.vertex_count());
    const std::size_t elements = header.dimension("num_elem", mesh_.triangle_count());
    const std::size_t blocks = header.dimension("num_el_blk", blocks_.all().size());
    const std::size_t sets = header.dimension("num_side_sets", sets_.all().size());

    header.variable("time_whole", kDouble, {step});
    header.variable("eb_status", kInt, {blocks});
    header.variable("eb_prop1", kInt, {blocks}).text("name", "ID");
    header.variable("eb_names", kChar, {blocks, name});
    std::vector<std::size_t> in_block;
    for (std::size_t b = 0; b < blocks_.all().size(); ++b) {
      in_block.push_back(header.dimension(numbered("num_el_in_blk", b), blocks_.all()[b].count));
      const std::size_t corners =
          header.dimension(numbered("num_nod_per_el", b), mesh_.triangle_nodes());
      header.variable(numbered("connect", b), kInt, {in_block.back(), corners})
          .text("elem_type", mesh_.order == 2 ? "TRI6" : "TRI3");
    }
    header.variable("elem_num_map", kInt, {elements});
    header.variable("coordx", kDouble, {nodes});
    header.variable("coordy", kDouble, {nodes});
    header.variable("coor_names", kChar, {axes, name});
    header.variable("ss_status", kInt, {sets});
    header.variable("ss_prop1", kInt, {sets}).text("name", "ID");
    header.variable("ss_names", kChar, {sets, name});
    for (std::size_t s = 0; s < sets_.all().size(); ++s) {
      const std::size_t sides = header.dimension(numbered("num_side_ss", s), sets_.all()[s].count);
      header.variable(numbered("elem_ss", s), kInt, {sides});
      header.variable(numbered("side_ss", s), kInt, {sides});
    }
    const std::size_t values = header.dimension("num_nod_var", mesh_.vertex_values.size());
    header.variable("name_nod_var", kChar, {values, name});
    for (std::size_t i = 0; i < mesh_.vertex_values.size(); ++i)
      header.variable(numbered("vals_nod_var", i), kDouble, {step, nodes});
    if (!mesh_.parts.empty()) {
      const std::size_t one = header.dimension("num_elem_var", 1);
      header.variable("name_elem_var", kChar, {one, name});
      header.variable("elem_var_tab", kInt, {blocks, one});
      for (std::size_t b = 0; b < in_block.size(); ++b)
        header.variable(numbered("vals_elem_var1eb", b), kDouble, {step, in_block[b]});
    }
    header.put(file_);
  }

  void put_results() {
    std::vector<std::string> names;
    for (const VertexValues& values : mesh_.vertex_values) names.push_back(values.name);
    put_names(names);
    for (const VertexValues& values : mesh_.vertex_values)
      for (const std::size_t v : mesh_.up_to(mesh_.vertex_count())) put(values.values[v]);
    if (mesh_.parts.empty()) return;
    put_names({"part"});
    for (std::size_t b = 0; b < blocks_.all().size(); ++b) put(std::int32_t{1});
    for (std::size_t b = 0; b < blocks_.all().size(); ++b)
      each_of(blocks_, b, [this](std::size_t t) { put(static_cast<double>(mesh_.parts[t])); });
  }

  const MeshView& mesh_;
  OutputFile& file_;
  MeshEdges edges_;
  ScratchArray<std::uint32_t> side_of_edge_;
  LabelGroups blocks_;                   // triangles by region
  ScratchArray<std::uint32_t> element_;  // the number of each triangle in the file, from 0
  LabelGroups sets_;                     // the mesh's own edges by marker
  std::vector<std::string> block_names_;
  std::vector<std::string> set_names_;
  std::size_t name_length_ = kUsualNameLength;  // bytes that the longest name needs
};

}  // namespace

void write_exodus(const MeshView& mesh, OutputFile& file) {
  constexpr std::size_t kMax = std::numeric_limits<std::int32_t>::max();
  if (mesh.vertex_count() > kMax || mesh.triangle_count() > kMax)
    throw std::system_error(EOVERFLOW, std::generic_category());
  Writer(mesh, file).write();
}

}  // namespace weft::files

// SPDX-License-Identifier: Apache-2.0
#include "files/formats/meshes/mfem.h"

#include <string>

#include "files/bytes/text_writer.h"
#include "files/formats/derived/label_tags.h"
#include "files/formats/derived/marked_edges.h"

namespace weft::files {
namespace {

// MFEM's numbers for the kinds of elements.
constexpr int kSegment = 1;
constexpr int kTriangle = 2;

// A set of one attribute for each name. A line holds a name and nothing else: MFEM's readers differ
// in what may follow it.
void put_names(OutputFile& file, const char* section, const LabelTags& labels) {
  std::string text;
  std::size_t count = 0;
  for (std::size_t i = 0; i < labels.ids.size(); ++i) {
    const std::string* const name = name_of(labels.names, labels.ids[i]);
    if (name == nullptr) continue;
    text += "\"" + *name + "\"\n1\n" + std::to_string(labels.tags[i]) + "\n";
    ++count;
  }
  put_line(file, section);
  put_line(file, count);
  file.put(text + "\n");
}

}  // namespace

void write_mfem(const MeshView& mesh, OutputFile& file) {
  const MeshEdges edges(mesh);
  const MarkedEdges marked(mesh, edges);
  const LabelTags regions(mesh.pages, mesh.regions, mesh.names->regions);
  const LabelTags markers(mesh.pages, marked.markers().values(), mesh.names->markers);
  const bool has_names = !mesh.names->empty();
  file.put(has_names ? "MFEM mesh v1.3\n\n" : "MFEM mesh v1.0\n\n");
  file.put("dimension\n2\n\nelements\n");
  put_line(file, mesh.triangle_count());
  for (const std::size_t t : mesh.up_to(mesh.triangle_count())) {
    const std::uint32_t* corner = &mesh.triangles[3 * t];
    put_line(file, regions.tags[regions.find(mesh.regions[t])], kTriangle, corner[0], corner[1],
             corner[2]);
  }
  file.put('\n');
  if (has_names) put_names(file, "attribute_sets", regions);
  put_line(file, "boundary");
  put_line(file, marked.size());
  for (const std::size_t i : mesh.up_to(marked.size())) {
    const auto [from, to] = marked.ends(i);
    put_line(file, markers.tags[markers.find(marked.marker(i))], kSegment, from, to);
  }
  file.put('\n');
  if (has_names) put_names(file, "bdr_attribute_sets", markers);
  put_line(file, "vertices");
  put_line(file, mesh.vertex_count());
  put_line(file, 2);
  for (const std::size_t v : mesh.up_to(mesh.vertex_count()))
    put_line(file, mesh.coordinates[2 * v], mesh.coordinates[2 * v + 1]);
  if (has_names) file.put("\nmfem_mesh_end\n");
}

}  // namespace weft::files

// SPDX-License-Identifier: Apache-2.0
#include "files/formats/meshes/msh_groups.h"

#include <algorithm>
#include <string>

#include "files/bytes/text_writer.h"

namespace weft::files {

void put_physical_names(OutputFile& file, const LabelTags& markers, const LabelTags& regions) {
  std::string text;
  std::size_t count = 0;
  const auto put = [&](const char* dimension, std::int32_t tag, const std::string& name) {
    text += dimension + std::to_string(tag) + " \"" + name + "\"\n";
    ++count;
  };
  const auto add = [&put](const char* dimension, const std::string& word, const LabelTags& groups) {
    for (std::size_t e = 0; e < groups.ids.size(); ++e) {
      const std::string* const name = name_of(groups.names, groups.ids[e]);
      put(dimension, groups.tags[e], name ? *name : word + std::to_string(groups.ids[e]));
    }
    for (const auto& [id, name] : groups.names)
      if (id > 0 && !std::binary_search(groups.ids.begin(), groups.ids.end(), id))
        put(dimension, id, name);
  };
  add("1 ", "marker ", markers);
  add("2 ", "region ", regions);
  file.put("$PhysicalNames\n" + std::to_string(count) + "\n" + text + "$EndPhysicalNames\n");
}

void put_node_data(OutputFile& file, const MeshView& mesh, bool binary) {
  for (const VertexValues& values : mesh.vertex_values) {
    // The name; the time 0; step 0, with one component per node.
    file.put("$NodeData\n1\n\"" + values.name + "\"\n1\n0\n3\n0\n1\n");
    put_line(file, values.values.size());
    for (const std::size_t v : mesh.up_to(values.values.size())) {
      if (!binary) {
        put_line(file, v + 1, values.values[v]);
        continue;
      }
      file.put_raw(static_cast<std::int32_t>(v + 1));
      file.put_raw(values.values[v]);
    }
    file.put(binary ? "\n$EndNodeData\n" : "$EndNodeData\n");
  }
}

}  // namespace weft::files

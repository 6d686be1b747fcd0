// SPDX-License-Identifier: Apache-2.0
#include "files/formats/meshes/netgen.h"

#include <algorithm>
#include <string>
#include <vector>

#include "files/bytes/text_writer.h"
#include "files/formats/derived/label_tags.h"
#include "files/formats/derived/marked_edges.h"

namespace weft::files {
namespace {

// Numbers from 1 without a gap for regions or markers: those that are there, and those that have a
// name.
class Places {
 public:
  Places(PagedMemory* pages, std::span<const std::int32_t> values, const NameTable& names)
      : names_(names), ids_(LabelTags(pages, values, names).ids) {
    for (const auto& [id, name] : names) ids_.push_back(id);
    std::sort(ids_.begin(), ids_.end());
    ids_.erase(std::unique(ids_.begin(), ids_.end()), ids_.end());
  }
  std::int64_t of(std::int32_t id) const {
    return std::lower_bound(ids_.begin(), ids_.end(), id) - ids_.begin() + 1;
  }
  void put(OutputFile& file, const char* section, NameKind kind) const {
    put_line(file, section);
    put_line(file, ids_.size());
    for (const std::int32_t id : ids_) {
      const std::string* const name = name_of(names_, id);
      put_line(file, of(id), name ? *name : std::string(word_of(kind)) + "_" + std::to_string(id));
    }
    file.put('\n');
  }

 private:
  const NameTable& names_;
  std::vector<std::int32_t> ids_;  // ascending
};

// "surfid 0 p1 p2 trignum1 trignum2 domin domout ednr1 dist1 ednr2 dist2": from p1 to p2, `domin`
// is on the left. There is no geometry, so what tells of it is 0.
void put_edges(OutputFile& file, const MeshView& mesh, const Places& domains) {
  const MeshEdges edges(mesh);
  const MarkedEdges marked(mesh, edges);
  const Places conditions(mesh.pages, marked.markers().values(), mesh.names->markers);
  const ScratchArray<std::uint32_t> first = first_sides(mesh, edges);
  const ScratchArray<std::uint32_t> opposite = opposite_sides(mesh, edges);
  const auto domain_at = [&](std::uint32_t side) {
    return side == kNoSide ? 0 : domains.of(mesh.regions[side / 3]);
  };
  put_line(file, "edgesegmentsgi2");
  put_line(file, marked.size());
  for (const std::size_t i : mesh.up_to(marked.size())) {
    auto [from, to] = marked.ends(i);
    const std::uint32_t side = first[marked.edge(i)];
    const std::uint32_t other = side == kNoSide ? kNoSide : opposite[side];
    if (side != kNoSide && mesh.triangles[side] != from) std::swap(from, to);
    const std::int64_t condition = conditions.of(marked.marker(i));
    put_line(file, condition, 0, from + std::int64_t{1}, to + std::int64_t{1}, 0, 0,
             domain_at(side), domain_at(other), condition, 0, condition, 0);
  }
  file.put('\n');
  conditions.put(file, "bcnames", NameKind::kMarker);
}

}  // namespace

void write_netgen(const MeshView& mesh, OutputFile& file) {
  const Places domains(mesh.pages, mesh.regions, mesh.names->regions);
  file.put("mesh3d\ndimension\n2\ngeomtype\n0\n\nsurfaceelements\n");
  put_line(file, mesh.triangle_count());
  for (const std::size_t t : mesh.up_to(mesh.triangle_count())) {
    // "surfnr bcnr domin domout np p1 p2 p3": of two dimensions `bcnr` is the domain.
    const std::uint32_t* corner = &mesh.triangles[3 * t];
    const std::int64_t domain = domains.of(mesh.regions[t]);
    put_line(file, domain + 1, domain, 0, 0, 3, corner[0] + std::int64_t{1},
             corner[1] + std::int64_t{1}, corner[2] + std::int64_t{1});
  }
  file.put('\n');
  put_edges(file, mesh, domains);
  put_line(file, "points");
  put_line(file, mesh.vertex_count());
  for (const std::size_t v : mesh.up_to(mesh.vertex_count()))
    put_line(file, mesh.coordinates[2 * v], mesh.coordinates[2 * v + 1], 0);
  file.put('\n');
  domains.put(file, "materials", NameKind::kRegion);
  file.put("endmesh\n");
}

}  // namespace weft::files

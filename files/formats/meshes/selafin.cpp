// SPDX-License-Identifier: Apache-2.0
#include "files/formats/meshes/selafin.h"

#include <cerrno>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

#include "files/bytes/big_endian.h"
#include "files/formats/bed.h"
#include "files/formats/derived/mesh_edges.h"

namespace weft::files {
namespace {

constexpr std::size_t kMaxBytes = std::numeric_limits<std::int32_t>::max();  // of a record

// Texts of a record are padded with blanks.
std::string filled(std::string text, std::size_t size) {
  text.resize(size, ' ');
  return text;
}

class Records {
 public:
  explicit Records(OutputFile& file) : file_(file) {}

  void text(const std::string& value) {
    length(value.size());
    file_.put(value);
    length(value.size());
  }
  void integers(std::initializer_list<std::size_t> values) {
    length(4 * values.size());
    for (const std::size_t value : values) put_big_endian(file_, static_cast<std::int32_t>(value));
    length(4 * values.size());
  }
  // `value(i)` is an std::int32_t or a double.
  template <class Value>
  void array(Numbers numbers, std::size_t count, const Value& value) {
    const std::size_t bytes = count * sizeof(value(std::size_t{0}));
    length(bytes);
    for (const std::size_t i : numbers) put_big_endian(file_, value(i));
    length(bytes);
  }

 private:
  void length(std::size_t bytes) { put_big_endian(file_, static_cast<std::int32_t>(bytes)); }

  OutputFile& file_;
};

// The number of each vertex along the boundary, from 1; 0 inside.
ScratchArray<std::int32_t> boundary_numbers(const MeshView& mesh) {
  ScratchArray<std::int32_t> numbers(mesh.pages, mesh.vertex_count());
  const BoundaryRings rings = boundary_rings(mesh, MeshEdges(mesh));
  std::int32_t last = 0;
  for (const bool outside : {true, false})
    for (std::size_t r = 0; r < rings.size(); ++r) {
      const auto ring =
          std::span(rings.vertices).subspan(rings.starts[r], rings.starts[r + 1] - rings.starts[r]);
      if ((signed_area(mesh, ring) > 0) != outside) continue;
      for (const std::uint32_t v : ring)
        if (numbers[v] == 0) numbers[v] = ++last;
    }
  return numbers;
}

}  // namespace

void write_selafin(const MeshView& mesh, OutputFile& file) {
  if (mesh.triangles.size_bytes() > kMaxBytes || mesh.coordinates.size_bytes() / 2 > kMaxBytes)
    return file.fail(EFBIG);
  const Bed bed(mesh);
  std::vector<const VertexValues*> others;
  for (const VertexValues& values : mesh.vertex_values)
    if (!Bed::is_bed(values.name)) others.push_back(&values);

  Records records(file);
  records.text(filled("weft", 72) + "SERAFIND");
  records.integers({1 + others.size(), 0});
  records.text(filled("BOTTOM", 16) + filled("M", 16));
  for (const VertexValues* values : others) records.text(filled(values->name, 32));
  records.integers({1, 0, 0, 0, 0, 0, 0, 0, 0, 0});  // one plane, no offset, no date
  const std::size_t nodes = mesh.vertex_count();
  records.integers({mesh.triangle_count(), nodes, 3, 1});
  records.array(mesh.up_to(mesh.triangles.size()), mesh.triangles.size(),
                [&](std::size_t i) { return static_cast<std::int32_t>(mesh.triangles[i] + 1); });
  const ScratchArray<std::int32_t> boundary = boundary_numbers(mesh);
  records.array(mesh.up_to(nodes), nodes, [&](std::size_t v) { return boundary[v]; });
  for (const std::size_t axis : {0, 1})
    records.array(mesh.up_to(nodes), nodes,
                  [&](std::size_t v) { return mesh.coordinates[2 * v + axis]; });
  records.array(mesh.up_to(1), 1, [](std::size_t) { return 0.0; });  // the time
  records.array(mesh.up_to(nodes), nodes, [&](std::size_t v) { return bed.elevation(v); });
  for (const VertexValues* values : others)
    records.array(mesh.up_to(nodes), nodes, [&](std::size_t v) { return values->values[v]; });
}

}  // namespace weft::files

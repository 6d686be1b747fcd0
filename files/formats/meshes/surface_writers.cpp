// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <span>
#include <string>

#include "files/bytes/text_writer.h"
#include "files/formats/meshes/surface_formats.h"

namespace weft::files {

void write_obj(const MeshView& mesh, OutputFile& file) {
  for (const std::size_t v : mesh.up_to(mesh.vertex_count()))
    put_line(file, "v", mesh.coordinates[2 * v], mesh.coordinates[2 * v + 1], 0);
  const auto put_group = [&file](const char* word, std::span<const std::int32_t> values,
                                 const NameTable& names, std::size_t i) {
    if (i > 0 && values[i] == values[i - 1]) return;
    const std::string* const name = name_of(names, values[i]);
    put_line(file, "g", name ? *name : word + std::to_string(values[i]));
  };
  for (const std::size_t t : mesh.up_to(mesh.triangle_count())) {
    put_group("region_", mesh.regions, mesh.names->regions, t);
    const std::uint32_t* corner = &mesh.triangles[3 * t];
    put_line(file, "f", corner[0] + std::int64_t{1}, corner[1] + std::int64_t{1},
             corner[2] + std::int64_t{1});
  }
  for (const std::size_t e : mesh.up_to(mesh.edge_count())) {
    put_group("marker_", mesh.edge_markers, mesh.names->markers, e);
    put_line(file, "l", mesh.edges[2 * e] + std::int64_t{1},
             mesh.edges[2 * e + 1] + std::int64_t{1});
  }
}

void write_off(const MeshView& mesh, OutputFile& file) {
  put_line(file, "OFF");
  put_line(file, mesh.vertex_count(), mesh.triangle_count(), 0);
  for (const std::size_t v : mesh.up_to(mesh.vertex_count()))
    put_line(file, mesh.coordinates[2 * v], mesh.coordinates[2 * v + 1], 0);
  for (const std::size_t t : mesh.up_to(mesh.triangle_count())) {
    const std::uint32_t* corner = &mesh.triangles[3 * t];
    put_line(file, 3, corner[0], corner[1], corner[2]);
  }
}

void write_ply(const MeshView& mesh, OutputFile& file) {
  file.put("ply\nformat binary_little_endian 1.0\ncomment weft\nelement vertex " +
           std::to_string(mesh.vertex_count()) +
           "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
           std::to_string(mesh.triangle_count()) +
           "\nproperty list uchar int vertex_indices\nend_header\n");
  for (const std::size_t v : mesh.up_to(mesh.vertex_count())) {
    const double at[] = {mesh.coordinates[2 * v], mesh.coordinates[2 * v + 1], 0.0};
    file.put_array(std::span<const double>(at));
  }
  for (const std::size_t t : mesh.up_to(mesh.triangle_count())) {
    file.put('\3');
    file.put_array(mesh.triangles.subspan(3 * t, 3));
  }
}

void write_stl(const MeshView& mesh, OutputFile& file) {
  char header[80] = "weft";
  file.put_array(std::span<const char>(header));
  file.put_raw(static_cast<std::uint32_t>(mesh.triangle_count()));
  for (const std::size_t t : mesh.up_to(mesh.triangle_count())) {
    float numbers[12] = {0, 0, 1};  // the normal, then the corners
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t axis = 0; axis < 2; ++axis)
        numbers[3 + 3 * k + axis] =
            static_cast<float>(mesh.coordinates[2 * std::size_t{mesh.triangles[3 * t + k]} + axis]);
    file.put_array(std::span<const float>(numbers));
    file.put_raw(std::uint16_t{0});
  }
}

}  // namespace weft::files

// SPDX-License-Identifier: Apache-2.0
#include "files/formats/meshes/modflow.h"

#include <cstdint>
#include <span>

#include "files/bytes/text_writer.h"
#include "files/formats/bed.h"
#include "files/formats/derived/voronoi_cells.h"

namespace weft::files {

void write_disv(const MeshView& mesh, OutputFile& file) {
  const VoronoiCells cells(mesh);
  const Bed bed(mesh);
  file.put("# Voronoi cells of a triangle mesh of weft\nBEGIN OPTIONS\n");
  if (mesh.unit == CoordinateUnit::kMetres) file.put("  LENGTH_UNITS METERS\n");
  file.put("END OPTIONS\n\nBEGIN DIMENSIONS\n");
  put_line(file, "  NLAY", 1);
  put_line(file, "  NCPL", cells.cell_count());
  put_line(file, "  NVERT", cells.corner_count());
  file.put("END DIMENSIONS\n\nBEGIN GRIDDATA\n");
  const auto put_plane = [&](const char* name, double shift) {
    file.put(name);
    if (!bed.is_known()) return put_line(file, "    CONSTANT", shift);
    file.put("    INTERNAL FACTOR 1.0\n");
    cells.each_cell([&](std::uint32_t vertex, std::span<const std::uint32_t>) {
      put_line(file, bed.elevation(vertex) + shift);
    });
  };
  put_plane("  TOP\n", 0);
  put_plane("  BOTM\n", -1);
  file.put("END GRIDDATA\n\nBEGIN VERTICES\n");
  std::uint64_t number = 0;
  cells.each_corner([&](Point at) { put_line(file, ++number, at.x, at.y); });
  file.put("END VERTICES\n\nBEGIN CELL2D\n");
  number = 0;
  cells.each_cell([&](std::uint32_t vertex, std::span<const std::uint32_t> corners) {
    file.number(static_cast<std::int64_t>(++number));
    file.put(' ');
    file.number(mesh.coordinates[2 * std::size_t{vertex}]);
    file.put(' ');
    file.number(mesh.coordinates[2 * std::size_t{vertex} + 1]);
    file.put(' ');
    file.number(static_cast<std::int64_t>(corners.size()));
    for (const std::uint32_t corner : corners) {
      file.put(' ');
      file.number(static_cast<std::int64_t>(corner) + 1);
    }
    file.put('\n');
  });
  file.put("END CELL2D\n");
}

}  // namespace weft::files

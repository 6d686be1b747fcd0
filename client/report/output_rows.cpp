// SPDX-License-Identifier: Apache-2.0
#include "client/report/output_rows.h"

namespace weft::client {

const OptionRows<MeshWriteOptions>& writing_rows() {
  using Writing = MeshWriteOptions;
  static const OptionRows<Writing> rows = {
      {"order", "WEFT_ORDER",
       "Order of the triangles written: 2 writes six-node triangles with straight sides, to .vtu, "
       ".msh and .node",
       "1", one_of(&Writing::order, {{"1", 1}, {"2", 2}})},
      {"msh-version", "WEFT_MSH_VERSION",
       "Version of .msh files: 4.1, binary, or 2.2, text, for older programs", "4.1",
       one_of(&Writing::msh_version, {{"2.2", MshVersion::k22}, {"4.1", MshVersion::k41}})},
      {"open-boundary", "",
       "Marker of segments that ADCIRC's .14 and .grd files have as open boundary; the others are "
       "land. May be repeated",
       "", integers("MARKER", &Writing::open_boundaries)},
  };
  return rows;
}

const OptionRows<MeshOutputOptions>& drawing_rows() {
  using Output = MeshOutputOptions;
  static const OptionRows<Output> rows = {
      {"color", "WEFT_COLOR", "Colour of the triangles in drawings: by angle, by region or none",
       "none",
       one_of(&Output::color, {{"angle", DrawColor::kAngle},
                               {"region", DrawColor::kRegion},
                               {"none", DrawColor::kNone}})},
      {"draw-quadtree", "WEFT_DRAW_QUADTREE",
       "Draw the leaves of the quadtree that guided refinement over the mesh", "",
       on_or_off(&Output::draw_quadtree)},
  };
  return rows;
}

}  // namespace weft::client

// SPDX-License-Identifier: Apache-2.0
// Shapes of single entities of a drawing: lines with bulges, areas and points. Throws DxfFault.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "files/formats/domain.h"
#include "files/formats/domains/dxf_curves.h"
#include "files/formats/domains/dxf_entities.h"

namespace weft::files {

struct DxfShape {
  enum class Kind { kPoint, kLine, kArea } kind = Kind::kLine;
  // Of a line one, which ends at its first position if it is closed; of an area, those of which an
  // odd number encloses it. Of a point, the point.
  std::vector<ArcChain> rings{};
  // The ends of a line are computed, not in the file.
  bool has_computed_ends = false;
};

// Whether entities of the kind have shapes, or place what has.
bool is_drawn(std::string_view kind);
// Whether entities of the kind say something about the drawing, or only help to draw it.
bool is_annotation(std::string_view kind);

// The shape of an entity that is drawn and no INSERT. None if it is no curve: a mesh of faces, or a
// spline whose numbers do not belong together.
std::optional<DxfShape> shape_of(const DxfEntity& entity, const DxfPlacement& placement);

std::vector<ArcChain> hatch_rings(const DxfEntity& hatch, const DxfPlacement& placement);

}  // namespace weft::files

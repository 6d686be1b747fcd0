// SPDX-License-Identifier: Apache-2.0
// Reads a drawing in DXF, in text form, as AutoCAD and others write it. Arcs, circles and bulges
// are arcs of the domain; ellipses and splines, and arcs that blocks place with unequal scales, are
// chains of arcs (biarcs.h).
//
// Lines bound what is meshed, even those of closed polylines: every bounded face is (Fill::kSeeds).
// Hatches, solids and faces fill it for the eye: only in a drawing without lines are they polygons.
// Blocks are read where they are placed. The ends of arcs meet those of lines (dxf_ends.h).
//
// Entities are the features of one layer, "entities", with the attributes Layer, PaperSpace,
// SubClasses, Linetype, EntityHandle and Text, the pattern of a hatch: --where and --attribute go
// by these, which mean what they do in feature_properties.h.
//
// Warnings, with a kind, a count and the first line or feature: what is not read or on paper,
// filled areas beside lines, outlines in others. Errors (kUnreadableInput) name the file and the
// line, or the feature: those of DxfDrawing and dxf_model, of GeometryBuilder and
// feature_properties; a layer, an attribute or a condition that does not fit.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "files/base/error.h"
#include "files/formats/domain.h"
#include "files/formats/layer_options.h"

namespace weft::files {

Result<Domain> read_dxf(const std::filesystem::path& path, const LayerOptions& options);
// The text of the file, which messages call `file`.
Result<Domain> read_dxf_text(const std::string& file, std::string_view text,
                             const LayerOptions& options);

}  // namespace weft::files

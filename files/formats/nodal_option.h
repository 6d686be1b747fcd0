// SPDX-License-Identifier: Apache-2.0
// --nodal: values at the vertices of a mesh that is written, and how they are taken from rasters.
//
//   NodalOption depth{"depth", {RasterPath{"survey.tif", ""}, 5.0}};
//   auto sampled = sample_nodal(depth, mesh, {}, mesh.coordinates);
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "files/base/error.h"
#include "files/base/paged_memory.h"
#include "files/formats/field_raster.h"
#include "files/formats/mesh.h"

namespace weft::files {

struct NodalOption {
  std::string name;
  // A vertex has the value of the first that has one there: a raster, or a number, which has a
  // value everywhere.
  std::vector<std::variant<RasterPath, double>> sources;

  friend bool operator==(const NodalOption&, const NodalOption&) = default;
};

// Adds "NAME=FILE", "NAME=FILE:BAND" or "NAME=NUMBER" to the options: a source more if there is the
// name. A relative path is below `folder`. Returns an empty text, or what is wrong. A name has at
// most 16 letters, digits and underscores, the first a letter.
std::string add_nodal(const std::string& text, const std::filesystem::path& folder,
                      std::vector<NodalOption>& options);

// Empty if values of this name can be given beside the options; otherwise what is wrong with it.
std::string nodal_name_fault(const std::string& name, const std::vector<NodalOption>& options);

struct SampledValues {
  ScratchArray<double> values;  // one per vertex
  std::vector<std::string> warnings;
};

// Where the vertices of a mesh are: in the plane of the projection `crs`, or else in `system`, if
// that is known. Rasters that are elsewhere are projected, as those of fields are.
struct NodalPlane {
  std::string crs{};
  std::optional<CoordinateSystem> system{};
};

// Whether the sources of an option have values in the box, before there is a mesh. Errors: those of
// field_raster.h.
Result<void> check_nodal_sources(const NodalOption& option, const RasterBox& box,
                                 const NodalPlane& plane);

// Rasters are bilinear between the centres of their cells, and have no value more than half a cell
// outside of them or beside a cell without one. `places` has the coordinates of the vertices for
// messages.
//
// Errors (kUnreadableInput): those of field_raster.h; a vertex without a value, with its number and
// its place. Memory: that of the rasters, one at a time, and the values in the mesh's pages.
Result<SampledValues> sample_nodal(const NodalOption& option, const MeshView& mesh,
                                   const NodalPlane& plane, std::span<const double> places);

}  // namespace weft::files

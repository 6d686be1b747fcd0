// SPDX-License-Identifier: Apache-2.0
// A field that a size expression may name, as a caller says it: NAME=KIND.
//
//   auto field = FieldOption::parse("coast=distance:marker=2", "");
//   if (auto ok = fill(*field, domain, *size.add_fields()); !ok) return tl::unexpected(ok.error());
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <tl/expected.hpp>
#include <variant>
#include <vector>

#include "client/base/files.h"
#include "files/base/error.h"
#include "files/formats/domain.h"
#include "files/geo/domain_projection.h"
#include "weft/v1/mesh_service.pb.h"
#include "wire/domain_field.h"

namespace weft::client {

struct FieldOption {
  // The distance to the points, lines and borders of polygons of a file.
  struct DistanceToFile {
    std::filesystem::path file;
  };
  // The values of a raster's band; if it is empty, of the only one.
  struct Raster {
    std::filesystem::path file;
    std::string band;
  };
  // Values at the vertices of an earlier mesh; if the array's name is empty, of the only one.
  struct OnMesh {
    std::filesystem::path file;
    std::string array;
  };
  // `text` is NAME=distance, NAME=distance:marker=1,inlet, NAME=distance:FILE, NAME=width,
  // NAME=mesh:FILE[:ARRAY] or NAME=FILE[:BAND]; a relative path is below `folder`. The error is a
  // text that says what is wrong.
  static tl::expected<FieldOption, std::string> parse(const std::string& text,
                                                      const std::filesystem::path& folder);

  std::string name;
  std::variant<wire::DomainField, DistanceToFile, Raster, OnMesh> kind;
};

// Reads the field's file, if it has one; of a raster what covers the domain. With a projection, the
// domain is in its metres, and the file is projected: as what it is, for a raster that says so,
// else from longitude and latitude; but a mesh is in metres if the projection's result is to be.
// Without one, a raster is brought into the coordinate system of the domain if both name one.
// Returns sentences for the user. Errors: those of the file; a file of lines in another coordinate
// system than the domain, or the longitudes and latitudes of a projection.
Result<std::vector<std::string>> fill(const FieldOption& field, const Domain& domain,
                                      const DomainProjection* projection,
                                      std::uint64_t most_raster_values, v1::NamedField& out);

}  // namespace weft::client

// SPDX-License-Identifier: Apache-2.0
// Shared by all commands that have a domain meshed: reads it, and projects it if it is in longitude
// and latitude.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "client/base/error.h"
#include "client/call/mesh_request.h"
#include "client/formats/domain.h"
#include "client/geo/domain_projection.h"
#include "client/report/mesh_report.h"

namespace weft::client {

struct InputDomain {
  Domain domain;  // as it is sent
  // Null if the domain is sent as its file has it.
  std::shared_ptr<const DomainProjection> projection;
};

// `size` says how large triangles may be. Errors: those of read_domain and of
// DomainProjection::project; kUsage if the size is the path of a grid, but the projection has no
// name that the grid could have been made for.
Result<InputDomain> read_input_domain(const std::filesystem::path& path, const RequestOptions& size,
                                      const ProjectionOptions& options);

// The error of a server, which speaks of places in the plane, with the name of the projection.
Error in_plane(Error error, const InputDomain& input);

// Adds the projection and its warnings to the report; if the mesh is written in longitude and
// latitude, so are the places that the summary names.
void add_projection(const InputDomain& input, MeshReport& report);

}  // namespace weft::client

// SPDX-License-Identifier: Apache-2.0
// Shared by all commands that have a domain meshed: reads it, and projects it if it is in longitude
// and latitude.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "client/call/mesh_report.h"
#include "client/call/mesh_request.h"
#include "client/call/server_error.h"
#include "files/base/error.h"
#include "files/formats/domain.h"
#include "files/formats/layer_options.h"
#include "files/geo/domain_projection.h"

namespace weft::client {

struct InputDomain {
  Domain domain;  // as it is sent
  // Null if the domain is sent as its file has it.
  std::shared_ptr<const DomainProjection> projection;
  std::filesystem::path strict{};  // the file, if nothing of it may be left out; else empty
};

// `wanted` has the size, the names and the distance to merge. Errors: those of read_domain, of
// DomainProjection::project and of set_names; kUnreadableInput if the domain is to be projected,
// but its file says that it lies in a plane; kUsage if the size is the path of a grid, but the
// projection has no name that the grid could have been made for. `as_read`, if any, is called with
// the domain before it is projected. A domain of degrees that is not projected has a warning.
Result<InputDomain> read_input_domain(const DataPath& path, const RequestOptions& wanted,
                                      const ProjectionOptions& options, const LayerOptions& layers,
                                      const std::function<void(const Domain&)>& as_read = {});

// The last step of that: the domain that was read from `path`, projected if the options want it.
// `snap`: what the request asks to be merged.
Result<InputDomain> projected(const std::filesystem::path& path, Domain domain,
                              const ProjectionOptions& options, double snap);

// `options` may be null. The origin refers to both.
RequestOrigin origin_of(const InputDomain& input, const RequestOptions* options = nullptr);

// Warns of segments that are no part of the mesh. Error (kUnreadableInput): there are some, and the
// input is strict. `input` may be null. REQUIRES: add_projection, if there is one.
Result<void> add_outside_warning(const InputDomain* input, MeshReport& report);

// Adds the projection and its warnings to the report; if the mesh is written in longitude and
// latitude, so are the places that the summary names.
void add_projection(const InputDomain& input, MeshReport& report);

}  // namespace weft::client

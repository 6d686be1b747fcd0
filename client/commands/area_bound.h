// SPDX-License-Identifier: Apache-2.0
// The bounds on areas that a size asks for, at the triangles of a mesh file.
//
// This folder has more than 25 files because each command has its own.
#pragma once

#include <string>

#include "client/call/mesh_request.h"
#include "files/base/error.h"
#include "files/formats/area_bound.h"
#include "files/formats/mesh.h"

namespace weft::client {

// The bound of the size that the options ask for, on the mesh's own domain, in the unit of its
// coordinates; empty if they ask for none. `name` is the mesh's in errors. Errors: those of
// checker_size; kUsage for a size that is not understood. The mesh need not outlive it.
Result<MakeAreaBound> area_bound(const RequestOptions& size, const std::string& name,
                                 const Mesh& mesh);

}  // namespace weft::client

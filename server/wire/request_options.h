// SPDX-License-Identifier: Apache-2.0
// What a request asks of a mesh, for whoever looks at the mesh later.
#pragma once

#include "weft/v1/mesh_service.pb.h"

namespace weft::server {

// The request without its arrays: no points, segments, markers, seeds and regions, and no values of
// the size and its fields. The names of fields, markers and regions stay. At most some 100 KiB,
// most of it the size's expression, and the names (names.h). REQUIRES: the request is one that
// was admitted.
v1::GenerateMeshRequest options_of(const v1::GenerateMeshRequest& request);

}  // namespace weft::server

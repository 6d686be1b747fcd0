// SPDX-License-Identifier: Apache-2.0
// The name of a mesh that is still to be made: requests whose meshes are the same bytes have the
// same key.
//
// Law: what is spelled differently and means the same has one key: a default that is written out,
// markers that are all 0. What does not change the mesh is left out: threads, first_chunk,
// want_quadtree, no_cache, and of the budget all but max_triangles. What decides whether there is a
// mesh at all, allow_unrefined, is in the key: nobody gets a mesh that another one allowed to miss
// its bounds.
#pragma once

#include <string>
#include <string_view>

#include "weft/v1/mesh_service.pb.h"

namespace weft::server {

// 32 bytes: SHA-256 over the engine's version and the request. REQUIRES: check_shape(request) found
// nothing.
std::string mesh_key(v1::GenerateMeshRequest request);

// 32 bytes: SHA-256.
std::string sha256(std::string_view bytes);

}  // namespace weft::server

// SPDX-License-Identifier: Apache-2.0
// The name of a mesh that is still to be made: requests whose meshes are the same bytes have the
// same key.
//
// The names of markers and regions are in the key, although no byte of a chunk depends on them: a
// mesh that is found by its key has the names that were asked for. Two requests that differ in
// names alone are made twice, but a store keeps their chunks once.
//
// Law: what is spelled differently and means the same has one key: a default that is written out,
// markers that are all 0, the order of names. Every field of the request is in the key, those of
// tomorrow, too, but for the few in kNotInMeshKey. What decides whether there is a mesh at all,
// allow_unrefined, is in the key: nobody gets a mesh that another one allowed to miss its bounds.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "weft/v1/mesh_service.pb.h"

namespace weft::server {

// Paths of the fields of GenerateMeshRequest that change no byte of the mesh.
inline constexpr std::array<std::string_view, 6> kNotInMeshKey = {
    "threads",  "first_chunk",      "want_quadtree",
    "no_cache", "budget.max_bytes", "budget.max_seconds"};

// 32 bytes: SHA-256 over the engine's version and the request. REQUIRES: to_engine(request)
// has a value.
std::string mesh_key(v1::GenerateMeshRequest request);

// The same key if clients share nothing: only those of this name find the mesh by it.
std::string key_of_client(const std::string& key, const std::string& client);

// 32 bytes: SHA-256.
std::string sha256(std::string_view bytes);

}  // namespace weft::server

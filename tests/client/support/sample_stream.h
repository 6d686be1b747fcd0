// SPDX-License-Identifier: Apache-2.0
// The messages by which a server sends a mesh.
#pragma once

#include <cstddef>
#include <vector>

#include "client/base/files.h"
#include "files/formats/mesh.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::client {

// The stream that carries the mesh in so many chunks: accepted, progress, chunks, summary.
std::vector<v1::GenerateMeshResponse> stream_of(const Mesh& mesh, std::size_t chunks);

// Computes the digests of the chunks and of the summary anew.
void seal(std::vector<v1::GenerateMeshResponse>& stream);

}  // namespace weft::client

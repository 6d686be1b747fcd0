// SPDX-License-Identifier: Apache-2.0
// Meshes to write, read, draw and stream: a square [0, n] x [0, n] of n x n unit squares, each cut
// in two triangles. The left half is region 0, the right half region 7; the sides are marked 1 to 4
// from the bottom counter-clockwise.
#pragma once

#include <cstdint>
#include <vector>

#include "client/formats/domain.h"
#include "client/formats/mesh.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::client {

Mesh square_mesh(std::uint32_t n);

// Two triangles, the edge between them, and their boundary but for the right side, which has no
// edge. Some regions and markers have names.
Mesh two_triangles();

// The square's outline: the domain of which square_mesh(n) is a mesh.
Domain square_domain(std::uint32_t n);

// The stream that carries the mesh in so many chunks: accepted, progress, chunks, summary.
std::vector<v1::GenerateMeshResponse> stream_of(const Mesh& mesh, std::size_t chunks);

// Computes the digests of the chunks and of the summary anew.
void seal(std::vector<v1::GenerateMeshResponse>& stream);

}  // namespace weft::client

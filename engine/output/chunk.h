// SPDX-License-Identifier: Apache-2.0
// A piece of the finished mesh, and its receiver.
//
// Chunks are numbered from 0 and come in order; together they are the whole mesh. Vertices and
// triangles are numbered from 0 across the mesh, in the order in which chunks carry them. A chunk
// refers only to its own vertices and to those of earlier chunks. The same request gives the same
// chunks, byte for byte.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/base/geometry.h"

namespace weft {

using Digest = std::array<std::uint8_t, 32>;  // SHA-256

struct Chunk {
  // An edge of the mesh that lies on an input segment. It is carried once, even if its two
  // triangles are in different chunks.
  struct Edge {
    std::uint32_t a = 0;  // mesh vertex
    std::uint32_t b = 0;
    std::uint32_t segment = 0;  // index of the input segment
    std::int32_t marker = 0;
  };

  std::uint32_t index = 0;
  std::uint32_t first_vertex = 0;
  std::uint32_t first_triangle = 0;
  std::vector<double> coordinates;       // x0, y0, x1, y1, ... of the vertices from first_vertex
  std::vector<std::uint32_t> triangles;  // three mesh vertices each, counter-clockwise
  std::vector<std::int32_t> regions;     // region id per triangle; empty if every id is 0
  std::vector<Edge> edges;
  // (mesh vertex, index of the input point) for the vertices of this chunk that are input points.
  std::vector<std::array<std::uint32_t, 2>> input_points;
  Box box;          // of this chunk's triangles
  Digest digest{};  // SHA-256 of the chunk's canonical bytes, see chunk_digest
};

// Maximum bytes of coordinates, triangles, regions, edges and input points per chunk.
inline constexpr std::size_t kMaxChunkBytes = std::size_t{1} << 20;

// SHA-256 over, little-endian and without padding: coordinates, triangles, regions (written out
// even when all are 0), edges (a, b, segment, marker), input_points.
Digest chunk_digest(const Chunk& chunk);

// Receives the chunks in order, on the thread that called `generate_mesh`. `accept` may block: only
// its own run waits. Returning false stops the run with kCancelled.
class ChunkSink {
 public:
  virtual ~ChunkSink() = default;
  virtual bool accept(Chunk&& chunk) = 0;
};

}  // namespace weft

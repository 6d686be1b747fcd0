// SPDX-License-Identifier: Apache-2.0
// What the tests of many threads share.
#pragma once

#include <cstdint>
#include <string>

#include "engine/engine.h"
#include "tests/engine/domain/shapes.h"
#include "tests/support/collected_mesh.h"

namespace weft {

// Sanitizers slow the engine down tenfold; what borders there are is what counts, not how many.
#ifdef WEFT_SANITIZED
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

// Takes chunks and forgets them: the summary's digest tells what they were.
struct ForgetfulSink : ChunkSink {
  bool accept(Chunk&&) override { return true; }
};

// Meshes on all threads of an arena, or without one.
inline Result<Summary> mesh_on(Arena* arena, const MeshRequest& request, ChunkSink& sink) {
  ExecutionContext context({.triangle_limit = 5'000'000});
  if (arena) context.set_arena(*arena);
  return generate_mesh(request, sink, context);
}

inline Result<Summary> mesh_on(Arena* arena, const MeshRequest& request) {
  ForgetfulSink sink;
  return mesh_on(arena, request, sink);
}

// What a run gives, for comparison: the digest and the statistics that are not of time, or the
// error.
inline std::string outcome(const Result<Summary>& result) {
  if (!result) return "error: " + result.error().field + ": " + result.error().message;
  std::string text;
  for (const unsigned byte : result->digest) {
    constexpr char kDigits[] = "0123456789abcdef";
    text += {kDigits[byte >> 4], kDigits[byte & 15]};
  }
  for (const std::uint64_t n :
       {result->vertices, result->triangles, result->edges, std::uint64_t{result->chunks},
        result->insertions, result->deferred, result->unrefined.total(),
        std::uint64_t{result->rounds}, std::uint64_t{result->leaves.size()}})
    text += " " + std::to_string(n);
  return text;
}

// A square on which the size asks for about so many triangles.
inline MeshRequest busy_square(double triangles, double leaf_triangles) {
  return {.pslg = square(), .size = 1.04 / triangles, .leaf_triangles = leaf_triangles};
}

}  // namespace weft

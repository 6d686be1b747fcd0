// SPDX-License-Identifier: Apache-2.0
// The engine behind the library's face (weft/weft.h): what `stream` runs, with the context of its
// own side of a run, which tests and benchmarks set up to trace it.
#pragma once

#include "engine/base/context.h"
#include "weft/weft.h"

namespace weft {

// As `stream`. Computes in the context's arena.
Result<Summary> generate_mesh(const MeshRequest& request, ChunkSink& sink,
                              ExecutionContext& context);

}  // namespace weft

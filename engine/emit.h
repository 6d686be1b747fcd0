// SPDX-License-Identifier: GPL-3.0-or-later
// From the refined mesh to the chunks that leave: numbering, figures, digests.
#pragma once

#include <cstdint>

#include "engine/chunk.h"
#include "engine/context.h"
#include "engine/domain/domain.h"
#include "engine/error.h"
#include "engine/refine/acute_corners.h"
#include "engine/refine/mesh.h"
#include "engine/summary.h"

namespace weft {

struct Emitted {
  double sink_seconds = 0;       // spent in the sink
  std::uint64_t peak_bytes = 0;  // of the numbering and the chunk at work
};

// Sends the mesh in the order of its triangles; vertices are numbered as they are first used. Fills
// the counts, figures and digest of the summary. `area` gives the bounds for the size histogram: it
// has bounds_at, as ConstantArea and MappedArea do.
template <class AreaBound>
Result<Emitted> emit(const Mesh& mesh, const Domain& domain, const AcuteCorners& corners,
                     AreaBound& area, ChunkSink& sink, ExecutionContext& context, Summary& summary);

}  // namespace weft

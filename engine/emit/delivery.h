// SPDX-License-Identifier: Apache-2.0
// Sends the fragments of a mesh in their order, as chunks that know their place in it, and sums up
// the statistics and the digest of the mesh.
//
// Errors: what stopped the context, or kCancelled, if the sink accepts no more. Not thread-safe:
// the caller's thread sends.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "engine/base/context.h"
#include "engine/emit/digest.h"
#include "engine/emit/fragment.h"
#include "engine/emit/quality_statistics.h"
#include "weft/error.h"
#include "weft/mesh.h"

namespace weft {

inline Unrefined& operator+=(Unrefined& sum, const Unrefined& other) {
  sum.small_input_angle += other.small_input_angle;
  sum.edge_floor += other.edge_floor;
  sum.kept += other.kept;
  sum.budget += other.budget;
  sum.precision += other.precision;
  sum.streaming += other.streaming;
  sum.too_large += other.too_large;
  return sum;
}

class Delivery {
 public:
  Delivery(ChunkSink& sink, const ExecutionContext& context, Summary& summary)
      : sink_(sink), context_(context), summary_(summary) {}

  // Numbers the chunks of the fragment and gives them to the sink.
  std::optional<Error> send(Fragment&& fragment) {
    statistics_.add(fragment.statistics);
    if (summary_.unrefined.without_exemption() == 0) summary_.unrefined_at = fragment.unrefined_at;
    if (fragment.kept_area > kept_area_) {
      kept_area_ = fragment.kept_area;
      summary_.kept_at = fragment.kept_at;
    }
    summary_.unrefined += fragment.unrefined;
    summary_.edges += fragment.edges;
    for (Chunk& chunk : fragment.chunks) {
      chunk.index = summary_.chunks++;
      chunk.first_vertex = static_cast<std::uint32_t>(summary_.vertices);
      chunk.first_triangle = static_cast<std::uint32_t>(summary_.triangles);
      summary_.box.merge(chunk.box);
      summary_.vertices += chunk.coordinates.size() / 2;
      summary_.triangles += chunk.triangles.size() / 3;
      digest_.add(chunk.digest.data(), chunk.digest.size());
      if (sink_.accept(std::move(chunk))) continue;
      if (auto error = context_.poll()) return error;
      return Error{ErrorCode::kCancelled, "", "the receiver of the mesh has gone"};
    }
    return std::nullopt;
  }

  // Call after the last fragment.
  void finish() {
    statistics_.write(summary_);
    summary_.digest = digest_.finish();
  }

 private:
  ChunkSink& sink_;
  const ExecutionContext& context_;
  Summary& summary_;
  QualityStatistics statistics_;
  double kept_area_ = 0;  // of the triangle at Summary::kept_at
  Sha256 digest_;
};

}  // namespace weft

// SPDX-License-Identifier: Apache-2.0
// A mesh on which the gradation is measured within the domain (size/gradation/mesh_limit.h).
#pragma once

#include <cstdint>
#include <limits>
#include <map>

#include "engine/base/context.h"
#include "engine/size/fields/mesh_field.h"
#include "engine/size/size_function.h"
#include "weft/error.h"
#include "weft/mesh.h"
#include "weft/weft.h"

namespace weft {

// Takes the chunks of a mesh, and from them where lengths of edges grow from besides the size:
// segments with sizes of their own, and regions.
class GradationMesh final : public ChunkSink {
 public:
  // How long edges of the mesh should be, as a share of what the gradation across land makes them.
  static double share_of_edges(double gradation);

  // REQUIRES: the mesh is that of `request`, which outlives this.
  explicit GradationMesh(const MeshRequest& request);

  bool accept(Chunk&& chunk) override;

  // A length of edges that grows by at most the gradation along any path in the domain, and is
  // nowhere above `size` or what grows from segments and regions; effectively infinite in parts of
  // the domain without any. The run holds `held` bytes besides. Errors: those of the context.
  Result<MeshField> limit(const SizeFunction& size, std::uint64_t held,
                          const ExecutionContext& context) &&;

 private:
  void lower(std::uint32_t v, double to);

  const SizeSpec& size_;
  std::map<std::int32_t, double> region_edges_;  // by the id; the least of several
  FieldMesh mesh_;
};

}  // namespace weft

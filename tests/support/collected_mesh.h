// SPDX-License-Identifier: Apache-2.0
// A mesh as its chunks bring it, in the checker's terms, and the checker's verdict on it.
//
//   CollectedMesh mesh;
//   Result<Summary> summary = stream(request, mesh, run);
//   EXPECT_EQ(verdict(request, mesh, *summary), "");
#pragma once

#include <string>

#include "checker/check.h"
#include "weft/mesh.h"
#include "weft/weft.h"

namespace weft {

// Takes chunks and holds them to their laws: index, first_vertex and first_triangle go on where
// the last chunk ended, nothing refers ahead, the digest is right, at most kMaxChunkBytes.
class CollectedMesh : public ChunkSink {
 public:
  bool accept(Chunk&& chunk) override;

  check::Mesh mesh;
  std::uint32_t chunks = 0;
  std::string broken_law;  // the first one that did not hold

 private:
  void must(bool holds, const char* law);
};

check::Domain domain_of(const Pslg& pslg);

// "" when the chunks were lawful, the checker finds nothing, and the summary agrees with the mesh;
// otherwise what is wrong.
std::string verdict(const MeshRequest& request, const CollectedMesh& collected,
                    const Summary& summary);

}  // namespace weft

// SPDX-License-Identifier: Apache-2.0
// A mesh that the checker has nothing against.
#pragma once

#include <gtest/gtest.h>

#include "tests/engine/parallel/parallel.h"
#include "tests/support/collected_mesh.h"

namespace weft {

struct Sound {
  CollectedMesh mesh;
  Summary summary;
};

// Meshes without an arena, at most 5 M triangles; fails the test if there is no mesh, or the
// checker finds anything.
inline Sound sound(const MeshRequest& request) {
  Sound made;
  const auto summary = mesh_on(nullptr, request, made.mesh);
  if (!summary) {
    ADD_FAILURE() << summary.error().message;
    return made;
  }
  made.summary = *summary;
  EXPECT_EQ(verdict(request, made.mesh, *summary), "");
  return made;
}

}  // namespace weft

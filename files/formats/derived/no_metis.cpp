// SPDX-License-Identifier: Apache-2.0
// Takes the place of mesh_parts.cpp in a build without METIS.
#include "files/formats/derived/mesh_parts.h"

namespace weft::files {

Result<void> check_can_divide() {
  return fail(ExitCode::kUsage, "--parts needs METIS, and this weft was built without it");
}

Result<MeshParts> divide(const MeshView&, std::uint32_t) {
  return tl::unexpected(check_can_divide().error());
}

}  // namespace weft::files

// SPDX-License-Identifier: Apache-2.0
// Warnings about sizes that are understood but hardly meant.
#pragma once

#include <string>
#include <vector>

#include "client/formats/domain.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::client {

// At most one line each for
//   - a size that is larger than the domain everywhere, and so bounds nothing,
//   - a raster of sizes whose nodes lie farther apart than the edges that it asks for,
//   - fields that the expression does not name.
std::vector<std::string> size_warnings(const v1::SizeField& size, const Domain& domain);

}  // namespace weft::client

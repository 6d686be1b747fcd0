// SPDX-License-Identifier: Apache-2.0
// The size of a request between the wire and the engine: the only place of the server that knows
// its kinds, but for their limits.
#pragma once

#include <optional>

#include "server/wire/errors.h"
#include "weft/v1/mesh_service.pb.h"
#include "weft/weft.h"

namespace weft::server {

// Refuses what only the wire has: grids and the lengths of arrays. Constant time for each field.
std::optional<Failure> check_shape(const v1::SizeField& size);

// Refuses what the engine would refuse without the domain: an expression with a fault, names,
// values that are no sizes. The values of fields it does not look at. Copies no array. REQUIRES:
// check_shape(size) returned nullopt.
std::optional<Failure> check_values(const v1::SizeField& size);

// REQUIRES: check_shape(size) returned nullopt.
SizeSpec to_engine(const v1::SizeField& size);

}  // namespace weft::server

// SPDX-License-Identifier: Apache-2.0
// The size of a request between the wire and the engine: the only place of the server that knows
// its kinds, but for their limits.
#pragma once

#include <memory>
#include <optional>

#include "engine/engine.h"
#include "server/wire/errors.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::server {

// Refuses what only the wire has: the grid of a raster. Constant time.
std::optional<Failure> check_shape(const v1::SizeField& size);

// Refuses what the engine would refuse: an expression with a fault, values that are no sizes.
// Copies no array. REQUIRES: check_shape(size) found nothing.
std::optional<Failure> check_values(const v1::SizeField& size);

// REQUIRES: check_shape(size) found nothing.
SizeSpec to_engine(const v1::SizeField& size);

// A size that asks for about as many triangles, without a copy of an array; no bound if `size` is
// none. REQUIRES: check_shape(size) found nothing.
std::unique_ptr<const SizeFunction> size_to_estimate_by(const v1::SizeField& size);

// Bytes of memory that the engine takes for arrays of `size`.
double bytes_to_expect(const v1::SizeField& size);

}  // namespace weft::server

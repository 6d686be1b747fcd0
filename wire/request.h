// SPDX-License-Identifier: Apache-2.0
// A request as the protocol spells it, weft.v1.GenerateMeshRequest, for the engine: the only place
// that knows both. weftd and libweft read requests by it.
//
//   Result<wire::Request> request = wire::read_request(bytes);
//   if (request) made = mesh(request->mesh);
//
// Fields that are not known are skipped, a field that comes again is merged or replaces the first
// one: as protobuf reads them. What does not concern the engine is not looked at: the names of
// markers and regions, first_chunk, no_cache.
#pragma once

#include <cstdint>
#include <string_view>

#include "weft/weft.h"

namespace weft::wire {

struct Request {
  MeshRequest mesh{};
  // What it may use. 0: any number.
  std::uint32_t threads = 0;
  std::uint64_t max_triangles = 0;
  std::uint64_t max_bytes = 0;
  double max_seconds = 0;
  bool want_quadtree = false;
};

// Errors, with the path of the field: kMalformedRequest for bytes that are no message, kBadArray
// for an array whose length makes no sense, kBadOption for a domain that is missing, enumerators,
// bounds, spacings of grids and seconds that are none. Options, sizes and the PSLG are judged by
// the engine. Linear time; each array is copied once. Throws std::bad_alloc alone.
Result<Request> read_request(std::string_view bytes);

}  // namespace weft::wire

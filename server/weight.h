// SPDX-License-Identifier: Apache-2.0
// How much memory a request is expected to take, for whoever admits it. An estimate, in
// microseconds: the box of the points stands for the domain, a thousand samples for the size field,
// regions are not looked at. What a job may take at most is its budget, and the engine holds it.
#pragma once

#include <cstdint>

#include "server/limits.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::server {

// Bytes, at most what the request's budget allows. REQUIRES: check_shape and check_limits found
// nothing.
std::uint64_t expected_bytes(const v1::GenerateMeshRequest& request, const Limits& limits);

}  // namespace weft::server

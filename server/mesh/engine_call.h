// SPDX-License-Identifier: Apache-2.0
// The engine as the server calls it: no exception comes out.
#pragma once

#include <functional>
#include <memory>
#include <tl/expected.hpp>

#include "engine/engine.h"
#include "server/wire/errors.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::server {

// `generate_mesh`, or what a test puts in its place. Called on worker threads, several at once.
using EngineFn = std::function<Result<Summary>(const MeshRequest&, ChunkSink&, ExecutionContext&)>;

// Frees the request as soon as the engine's own form of it is made. What is thrown becomes a
// failure: OUT_OF_MEMORY for want of memory, INTERNAL else.
// REQUIRES: check_shape and check_limits found nothing in the request.
tl::expected<Summary, Failure> call_engine(const EngineFn& engine,
                                           std::unique_ptr<v1::GenerateMeshRequest> request,
                                           ChunkSink& sink, ExecutionContext& context) noexcept;

// The point in time that many seconds from now; far ones are brought near enough for the clock.
ExecutionContext::Clock::time_point seconds_from_now(double seconds);

}  // namespace weft::server

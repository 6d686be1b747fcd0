// SPDX-License-Identifier: Apache-2.0
// Between parsed messages and the engine: what wire/ has from bytes, and chunks.
//
// Lengths of arrays, options and the size are checked before a request is admitted. The engine
// checks coordinates and indices when it runs, and those of a job before the job is stored. Errors
// carry the path of the field as the wire spells it.
#pragma once

#include <grpcpp/support/byte_buffer.h>

#include <optional>
#include <tl/expected.hpp>

#include "server/wire/errors.h"
#include "server/wire/limits.h"
#include "weft/v1/mesh_service.pb.h"
#include "weft/weft.h"

namespace weft::server {

// Threads of `available` that a job takes at most, of which `wanted` are asked for; 0 is all.
std::uint32_t to_threads(std::uint32_t wanted, int available);

// Refuses arrays of impossible lengths, names of markers and regions with a fault, and what only
// the wire has (wire/request.h). Takes linear time, and meanwhile memory for the request's bytes.
tl::expected<MeshRequest, Failure> to_engine(const v1::GenerateMeshRequest& request);

// Refuses what the engine would refuse before it looks at the domain: options outside their ranges,
// and a size with a fault.
std::optional<Failure> check_values(const MeshRequest& request);

Budget to_budget(const v1::Budget& budget, const Limits& limits);
double to_seconds(const v1::Budget& budget, const Limits& limits);

// Writes over what `message` holds; its arrays keep their memory for the next chunk.
void to_wire(const Chunk& chunk, v1::Chunk& message);
// The summary of a job on so many threads, without the boxes of the quadtree's leaves.
v1::Summary to_wire(const Summary& summary, std::uint32_t threads);
// Adds those boxes, unless there are more than wire::kMaxLeafBoxes.
void add_quadtree(const Summary& summary, v1::Summary& message);
v1::Stage to_wire(Stage stage);
// Updates the progress that was sent last: nothing in it goes back.
void write_progress(const Progress& now, double elapsed_seconds, v1::Progress& progress);

// The bytes of a message, as one gRPC buffer.
grpc::ByteBuffer serialize(const google::protobuf::MessageLite& message);

}  // namespace weft::server

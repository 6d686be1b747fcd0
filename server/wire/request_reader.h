// SPDX-License-Identifier: Apache-2.0
// From the bytes of a call to a request that may be admitted: scanned, freed of unknown fields,
// held against the limits on what takes memory, and parsed; then, if there is memory for it,
// brought into the engine's form and judged. What is refused before that has cost no more memory
// than its bytes, unless they do not parse.
//
//   auto request = read_mesh_request(bytes, limits);
//   if (!request) return refuse(request.error());
//   auto converted = admissible(**request, limits);
//
// Errors: MALFORMED_REQUEST, LIMIT_EXCEEDED, BAD_ARRAY, BAD_OPTION, those of a size; all but the
// first name a field. The PSLG is not checked.
// The bytes are freed as they are read. Throws std::bad_alloc alone.
#pragma once

#include <google/protobuf/message.h>
#include <grpcpp/support/byte_buffer.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <tl/expected.hpp>

#include "server/wire/errors.h"
#include "server/wire/limits.h"
#include "weft/v1/job_service.pb.h"
#include "weft/v1/mesh_service.pb.h"
#include "weft/weft.h"

namespace weft::server {

tl::expected<std::unique_ptr<v1::GenerateMeshRequest>, Failure> read_mesh_request(
    grpc::ByteBuffer bytes, const Limits& limits);
// The mesh, and the name that the client gave to the job.
tl::expected<v1::SubmitJobRequest, Failure> read_submission(grpc::ByteBuffer bytes,
                                                            const Limits& limits);

// The request in the engine's form, if it is within the limits, and the engine refuses nothing of
// it before it looks at the domain. Takes time and memory as to_engine.
tl::expected<MeshRequest, Failure> admissible(const v1::GenerateMeshRequest& request,
                                              const Limits& limits);

// Any other message: small, and without arrays that take more memory than their bytes.
std::optional<Failure> read_small(grpc::ByteBuffer bytes, google::protobuf::Message& message);

}  // namespace weft::server

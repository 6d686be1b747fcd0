// SPDX-License-Identifier: Apache-2.0
// From the bytes of a call to a request that may be admitted: scanned, freed of unknown fields,
// parsed, held against the limits. What is refused has cost no more memory than its bytes.
//
//   auto request = read_mesh_request(bytes, limits);
//   if (!request) return refuse(request.error());
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

namespace weft::server {

tl::expected<std::unique_ptr<v1::GenerateMeshRequest>, Failure> read_mesh_request(
    grpc::ByteBuffer bytes, const Limits& limits);

// The mesh, and the name that the client gave to the job.
tl::expected<v1::SubmitJobRequest, Failure> read_submission(grpc::ByteBuffer bytes,
                                                            const Limits& limits);

// Any other message: small, and without arrays that take more memory than their bytes.
std::optional<Failure> read_small(grpc::ByteBuffer bytes, google::protobuf::Message& message);

}  // namespace weft::server

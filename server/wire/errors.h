// SPDX-License-Identifier: Apache-2.0
// What fails a call (wire/errors.h), as gRPC has it.
//
// Example:
//   Failure failure{Reason::kQueueFull, "", "64 calls wait already; the limit is 64"};
//   reactor->Finish(to_status(failure, job_id));
#pragma once

#include <grpcpp/support/status.h>

#include <string_view>

#include "server/wire/failure.h"
#include "wire/errors.h"

namespace weft::server {

using wire::error_table;
using wire::ErrorRow;
using wire::failure_of;
using wire::reason_of;
using wire::row_of;

grpc::StatusCode code_of(Reason reason);

// "INVALID_ARGUMENT" and so on.
std::string_view code_name(grpc::StatusCode code);

// A status whose details are those of wire::write_status. Long messages are cut: a client refuses
// trailers of more than 8 KiB.
grpc::Status to_status(Failure failure, std::string_view job_id);

}  // namespace weft::server

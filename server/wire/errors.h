// SPDX-License-Identifier: Apache-2.0
// The one table of what can go wrong with a call, and what each is called everywhere: the reason
// in ErrorInfo, the gRPC code, and whether the same request may succeed later. The command line
// exits with 64 + the gRPC code; metrics count by the gRPC code.
//
// Example:
//   Failure failure{Reason::kQueueFull, "", "64 calls wait already; the limit is 64"};
//   reactor->Finish(to_status(failure, job_id));
#pragma once

#include <grpcpp/support/status.h>

#include <span>
#include <string_view>

#include "server/wire/failure.h"
#include "weft/error.h"

namespace weft::server {

struct ErrorRow {
  Reason reason;
  std::string_view name;  // ErrorInfo.reason
  grpc::StatusCode code;
  bool retryable;  // the same request may succeed later; the status then carries a RetryInfo
};

// Indexed by Reason.
std::span<const ErrorRow> error_table();
const ErrorRow& row_of(Reason reason);
Reason reason_of(ErrorCode code);

// "INVALID_ARGUMENT" and so on.
std::string_view code_name(grpc::StatusCode code);

Failure failure_of(const Error& error);

// A status whose details are a google.rpc.Status: an ErrorInfo, a BadRequest if a field is at
// fault, a RetryInfo if a retry makes sense. The metadata of the ErrorInfo have the job's id as
// "job_id", unless that is empty, and the coordinates of the place at fault as "x" and "y", if
// there is one. Long messages are cut: a client refuses trailers of more than 8 KiB.
grpc::Status to_status(const Failure& failure, std::string_view job_id);

}  // namespace weft::server

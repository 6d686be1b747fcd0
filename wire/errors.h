// SPDX-License-Identifier: Apache-2.0
// The one table of what can go wrong with a request, a call or a job, and what each is called
// everywhere: the reason in google.rpc.ErrorInfo, the code of gRPC, and whether the same request
// may succeed later. The command line exits with 64 + the code; metrics count by the code.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "weft/error.h"
#include "wire/failure.h"

namespace weft::wire {

struct ErrorRow {
  Reason reason;
  std::string_view name;  // ErrorInfo.reason; ends with a 0 byte
  int code;               // as google.rpc.Code and gRPC number it
  bool retryable;         // the same request may succeed later; the status then carries a RetryInfo
};

// Indexed by Reason.
std::span<const ErrorRow> error_table();
const ErrorRow& row_of(Reason reason);
Reason reason_of(ErrorCode code);

Failure failure_of(const Error& error);

// A message of at most `max_bytes` and an ellipsis, not cut inside a character of UTF-8.
std::string cut(std::string message, std::size_t max_bytes);

// The bytes of a google.rpc.Status, whose details are an ErrorInfo, a BadRequest if a field is at
// fault, a RetryInfo if a retry makes sense. The metadata of the ErrorInfo have the job's id as
// "job_id", unless that is empty, and the coordinates of the place at fault as "x" and "y", if
// there is one.
std::string write_status(const Failure& failure, std::string_view job_id);

}  // namespace weft::wire

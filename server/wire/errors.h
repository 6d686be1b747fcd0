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

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "weft/error.h"

namespace weft::server {

// The engine's codes come first, in their order, then the server's own.
enum class Reason {
  kBadCoordinate,
  kIndexOutOfRange,
  kTooFewPoints,
  kCollinearPoints,
  kSeedOutsideDomain,
  kSeedOnSegment,
  kEmptyDomain,
  kBadOption,
  kExpressionSyntax,
  kExpressionTooComplex,
  kBadSizeValue,
  kLimitExceeded,
  kBudgetExceeded,
  kOutOfMemory,
  kDeadlineExceeded,
  kCancelled,
  kBoundsNotMet,
  kInternal,
  kMalformedRequest,  // bytes that are no GenerateMeshRequest
  kBadArray,          // an array whose length makes no sense
  kQueueFull,         // too many jobs wait
  kStopping,          // the server drains
  kReaderStalled,     // the client read nothing for too long
  kChunkOutOfRange,   // first_chunk is beyond the mesh
  kUnauthenticated,   // no token, or none that the server knows
  kNoSuchJob,         // none of this id, or another caller's
  kMeshGone,          // made, and no longer kept
  kJobNotDone,        // what is asked for needs a job that has ended, or succeeded
  kRequestIdReused,   // for another mesh
  kStoreUnavailable,  // the store does not answer
  kStoreFull,         // the store's disk is full
  kStoreBroken,       // the store holds what it was not given
  kWorkersLost,       // every worker that took the job was lost
};

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

// Why a call failed. `field` is the path of the field at fault, empty when none is; `at` is as in
// the engine's errors.
struct Failure {
  Reason reason = Reason::kInternal;
  std::string field;
  std::string message;
  std::optional<Point> at{};
};

Failure failure_of(const Error& error);
inline Failure bad_option(std::string field, std::string message) {
  return {Reason::kBadOption, std::move(field), std::move(message)};
}

// A status whose details are a google.rpc.Status: an ErrorInfo, a BadRequest if a field is at
// fault, a RetryInfo if a retry makes sense. The metadata of the ErrorInfo have the job's id as
// "job_id", unless that is empty, and the coordinates of the place at fault as "x" and "y", if
// there is one. Long messages are cut: a client refuses trailers of more than 8 KiB.
grpc::Status to_status(const Failure& failure, std::string_view job_id);

}  // namespace weft::server

// SPDX-License-Identifier: Apache-2.0
// Why a call failed; errors.h has the table of what each reason is on the wire.
//
//   return Failure{Reason::kQueueFull, "", "64 calls wait already; this server's limit is 64"};
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "weft/geometry.h"

namespace weft::wire {

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
  kMalformedRequest,
  kBadArray,
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

// Why a call failed. `field` is the path of the field at fault, empty when none is; `at` is as in
// the engine's errors.
struct Failure {
  Reason reason = Reason::kInternal;
  std::string field;
  std::string message;
  std::optional<Point> at{};
};

inline Failure bad_option(std::string field, std::string message) {
  return {Reason::kBadOption, std::move(field), std::move(message)};
}

}  // namespace weft::wire

// SPDX-License-Identifier: Apache-2.0
// Errors and their codes.
//
// No exception leaves the library: every function that can fail returns a Result<T>. An Error names
// the offender twice: `field` is a path in the request ("domain.segments[17].b", empty if no field
// is at fault), `message` is a sentence with the value, the index and the limit. `at` is the point
// of the plane that the message names, if it is not one of the request's own.
//
//   Result<Mesh> made = mesh(request);
//   if (!made) return tl::unexpected(made.error());
#pragma once

#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <utility>

#include "weft/geometry.h"

namespace weft {

enum class ErrorCode {
  // The request is wrong; the same request fails again.
  kBadCoordinate,         // NaN, infinite, or out of the range that the API documents
  kIndexOutOfRange,       // a segment names a point that does not exist
  kTooFewPoints,          // fewer than 3 distinct points
  kCollinearPoints,       // every point lies on one line
  kSeedOutsideDomain,     // a hole or region seed that lies in no bounded face
  kSeedOnSegment,         // a hole or region seed on a segment or point: its face is ambiguous
  kEmptyDomain,           // nothing is left after carving
  kBadOption,             // an option outside its documented range
  kExpressionSyntax,      // the size expression does not parse (column and caret in the message)
  kExpressionTooComplex,  // the size expression is too long or too deep
  kBadSizeValue,          // the size field is not finite or not positive at a point of the domain
  // The request needs more than it may use.
  kLimitExceeded,   // refused before work: an input or an estimate is over a limit
  kBudgetExceeded,  // stopped during work: bytes ran out
  kOutOfMemory,     // the machine is short of it; the same request may succeed later
  // The request was stopped from outside.
  kDeadlineExceeded,
  kCancelled,
  // The mesh was made but is not what was asked for: a triangle misses a bound, and neither an
  // angle of the input nor the caller's own budget or shortest edge exempts it.
  kBoundsNotMet,
  kInternal,          // the engine is wrong
  kMalformedRequest,  // bytes that are no message of the protocol
  kBadArray,          // an array of a message whose length makes no sense
};

struct Error {
  ErrorCode code = ErrorCode::kInternal;
  std::string field;
  std::string message;
  std::optional<Point> at{};
};

template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(ErrorCode code, std::string field, std::string message) {
  return tl::unexpected<Error>(Error{code, std::move(field), std::move(message)});
}

}  // namespace weft

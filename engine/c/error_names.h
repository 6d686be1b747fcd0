// SPDX-License-Identifier: Apache-2.0
// What errors are called beyond C++: in the C interface, and in the protocol
// (server/wire/errors.h).
#pragma once

#include "weft/error.h"

namespace weft {

// "BAD_OPTION" of kBadOption.
inline const char* name_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::kBadCoordinate:
      return "BAD_COORDINATE";
    case ErrorCode::kIndexOutOfRange:
      return "INDEX_OUT_OF_RANGE";
    case ErrorCode::kTooFewPoints:
      return "TOO_FEW_POINTS";
    case ErrorCode::kCollinearPoints:
      return "COLLINEAR_POINTS";
    case ErrorCode::kSeedOutsideDomain:
      return "SEED_OUTSIDE_DOMAIN";
    case ErrorCode::kSeedOnSegment:
      return "SEED_ON_SEGMENT";
    case ErrorCode::kEmptyDomain:
      return "EMPTY_DOMAIN";
    case ErrorCode::kBadOption:
      return "BAD_OPTION";
    case ErrorCode::kExpressionSyntax:
      return "EXPRESSION_SYNTAX";
    case ErrorCode::kExpressionTooComplex:
      return "EXPRESSION_TOO_COMPLEX";
    case ErrorCode::kBadSizeValue:
      return "BAD_SIZE_VALUE";
    case ErrorCode::kLimitExceeded:
      return "LIMIT_EXCEEDED";
    case ErrorCode::kBudgetExceeded:
      return "BUDGET_EXCEEDED";
    case ErrorCode::kOutOfMemory:
      return "OUT_OF_MEMORY";
    case ErrorCode::kDeadlineExceeded:
      return "DEADLINE_EXCEEDED";
    case ErrorCode::kCancelled:
      return "CANCELLED";
    case ErrorCode::kBoundsNotMet:
      return "BOUNDS_NOT_MET";
    case ErrorCode::kInternal:
      break;
  }
  return "INTERNAL";
}

}  // namespace weft

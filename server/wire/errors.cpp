// SPDX-License-Identifier: Apache-2.0
#include "server/wire/errors.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>

#include "google/rpc/code.pb.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace weft::server {
namespace {

constexpr bool kRetry = true;
constexpr bool kFinal = false;

using enum Reason;
using enum grpc::StatusCode;

constexpr std::array kTable = {
    ErrorRow{kBadCoordinate, "BAD_COORDINATE", INVALID_ARGUMENT, kFinal},
    ErrorRow{kIndexOutOfRange, "INDEX_OUT_OF_RANGE", INVALID_ARGUMENT, kFinal},
    ErrorRow{kTooFewPoints, "TOO_FEW_POINTS", INVALID_ARGUMENT, kFinal},
    ErrorRow{kCollinearPoints, "COLLINEAR_POINTS", INVALID_ARGUMENT, kFinal},
    ErrorRow{kSeedOutsideDomain, "SEED_OUTSIDE_DOMAIN", INVALID_ARGUMENT, kFinal},
    ErrorRow{kSeedOnSegment, "SEED_ON_SEGMENT", INVALID_ARGUMENT, kFinal},
    ErrorRow{kEmptyDomain, "EMPTY_DOMAIN", INVALID_ARGUMENT, kFinal},
    ErrorRow{kBadOption, "BAD_OPTION", INVALID_ARGUMENT, kFinal},
    ErrorRow{kExpressionSyntax, "EXPRESSION_SYNTAX", INVALID_ARGUMENT, kFinal},
    ErrorRow{kExpressionTooComplex, "EXPRESSION_TOO_COMPLEX", INVALID_ARGUMENT, kFinal},
    ErrorRow{kBadSizeValue, "BAD_SIZE_VALUE", INVALID_ARGUMENT, kFinal},
    ErrorRow{kLimitExceeded, "LIMIT_EXCEEDED", RESOURCE_EXHAUSTED, kFinal},
    ErrorRow{kBudgetExceeded, "BUDGET_EXCEEDED", RESOURCE_EXHAUSTED, kFinal},
    ErrorRow{kOutOfMemory, "OUT_OF_MEMORY", RESOURCE_EXHAUSTED, kRetry},
    ErrorRow{kDeadlineExceeded, "DEADLINE_EXCEEDED", DEADLINE_EXCEEDED, kFinal},
    ErrorRow{kCancelled, "CANCELLED", CANCELLED, kFinal},
    ErrorRow{kBoundsNotMet, "BOUNDS_NOT_MET", FAILED_PRECONDITION, kFinal},
    ErrorRow{kInternal, "INTERNAL", INTERNAL, kFinal},
    ErrorRow{kMalformedRequest, "MALFORMED_REQUEST", INVALID_ARGUMENT, kFinal},
    ErrorRow{kBadArray, "BAD_ARRAY", INVALID_ARGUMENT, kFinal},
    ErrorRow{kQueueFull, "QUEUE_FULL", RESOURCE_EXHAUSTED, kRetry},
    ErrorRow{kStopping, "STOPPING", UNAVAILABLE, kRetry},
    ErrorRow{kReaderStalled, "READER_STALLED", CANCELLED, kFinal},
    ErrorRow{kChunkOutOfRange, "CHUNK_OUT_OF_RANGE", OUT_OF_RANGE, kFinal},
    ErrorRow{kUnauthenticated, "UNAUTHENTICATED", UNAUTHENTICATED, kFinal},
    ErrorRow{kNoSuchJob, "NO_SUCH_JOB", NOT_FOUND, kFinal},
    ErrorRow{kMeshGone, "MESH_GONE", NOT_FOUND, kFinal},
    ErrorRow{kJobNotDone, "JOB_NOT_DONE", FAILED_PRECONDITION, kFinal},
    ErrorRow{kRequestIdReused, "REQUEST_ID_REUSED", ALREADY_EXISTS, kFinal},
    ErrorRow{kStoreUnavailable, "STORE_UNAVAILABLE", UNAVAILABLE, kRetry},
    ErrorRow{kStoreFull, "STORE_FULL", RESOURCE_EXHAUSTED, kRetry},
    ErrorRow{kStoreBroken, "STORE_BROKEN", DATA_LOSS, kFinal},
    ErrorRow{kWorkersLost, "WORKERS_LOST", ABORTED, kFinal},
};

constexpr bool indexed_by_reason() {
  for (std::size_t i = 0; i < kTable.size(); ++i)
    if (static_cast<std::size_t>(kTable[i].reason) != i) return false;
  return true;
}
static_assert(indexed_by_reason());
static_assert(static_cast<int>(ErrorCode::kBadCoordinate) == static_cast<int>(kBadCoordinate));
static_assert(static_cast<int>(ErrorCode::kBadSizeValue) == static_cast<int>(kBadSizeValue));
static_assert(static_cast<int>(ErrorCode::kInternal) == static_cast<int>(kInternal));

constexpr int kRetrySeconds = 1;

// A message travels three times, once percent-encoded and twice in base64: at worst six times its
// bytes, in trailers of at most 8 KiB.
constexpr std::size_t kMaxMessageBytes = 1000;

std::string cut(std::string text) {
  if (text.size() <= kMaxMessageBytes) return text;
  std::size_t end = kMaxMessageBytes;
  const auto continues = [&](std::size_t i) {
    return (static_cast<unsigned char>(text[i]) & 0xc0) == 0x80;
  };
  while (end > 0 && continues(end)) --end;  // not inside a UTF-8 character
  text.resize(end);
  return text + "...";
}

}  // namespace

std::span<const ErrorRow> error_table() {
  return kTable;
}

const ErrorRow& row_of(Reason reason) {
  return kTable[static_cast<std::size_t>(reason)];
}

Reason reason_of(ErrorCode code) {
  return static_cast<Reason>(code);
}

std::string_view code_name(grpc::StatusCode code) {
  return google::rpc::Code_Name(static_cast<google::rpc::Code>(code));
}

Failure failure_of(const Error& error) {
  return {reason_of(error.code), error.field, error.message, error.at};
}

grpc::Status to_status(const Failure& failure, std::string_view job_id) {
  const ErrorRow& row = row_of(failure.reason);
  const std::string message = cut(failure.message);

  google::rpc::Status details;
  details.set_code(row.code);
  details.set_message(message);

  google::rpc::ErrorInfo info;
  info.set_reason(std::string(row.name));
  info.set_domain("weft");
  auto& metadata = *info.mutable_metadata();
  if (!job_id.empty()) metadata["job_id"] = std::string(job_id);
  if (failure.at) {
    metadata["x"] = fmt::format("{}", failure.at->x);
    metadata["y"] = fmt::format("{}", failure.at->y);
  }
  details.add_details()->PackFrom(info);

  if (!failure.field.empty()) {
    google::rpc::BadRequest bad;
    auto* violation = bad.add_field_violations();
    violation->set_field(failure.field);
    violation->set_description(message);
    details.add_details()->PackFrom(bad);
  }
  if (row.retryable) {
    google::rpc::RetryInfo retry;
    retry.mutable_retry_delay()->set_seconds(kRetrySeconds);
    details.add_details()->PackFrom(retry);
  }
  return {row.code, message, details.SerializeAsString()};
}

}  // namespace weft::server

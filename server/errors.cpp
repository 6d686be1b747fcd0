// SPDX-License-Identifier: Apache-2.0
#include "server/errors.h"

#include <array>
#include <cstddef>

#include "google/rpc/code.pb.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace weft::server {
namespace {

constexpr ErrorRow row(Reason reason, std::string_view name, grpc::StatusCode code, bool retryable,
                       std::string_view metric) {
  return {reason, name, code, retryable, 64 + static_cast<int>(code), metric};
}

constexpr bool kRetry = true;
constexpr bool kFinal = false;

using enum Reason;
using enum grpc::StatusCode;

constexpr std::array kTable = {
    row(kBadCoordinate, "BAD_COORDINATE", INVALID_ARGUMENT, kFinal, "bad_coordinate"),
    row(kIndexOutOfRange, "INDEX_OUT_OF_RANGE", INVALID_ARGUMENT, kFinal, "index_out_of_range"),
    row(kTooFewPoints, "TOO_FEW_POINTS", INVALID_ARGUMENT, kFinal, "too_few_points"),
    row(kCollinearPoints, "COLLINEAR_POINTS", INVALID_ARGUMENT, kFinal, "collinear_points"),
    row(kZeroLengthSegment, "ZERO_LENGTH_SEGMENT", INVALID_ARGUMENT, kFinal, "zero_length_segment"),
    row(kSeedOutsideDomain, "SEED_OUTSIDE_DOMAIN", INVALID_ARGUMENT, kFinal, "seed_outside_domain"),
    row(kSeedOnSegment, "SEED_ON_SEGMENT", INVALID_ARGUMENT, kFinal, "seed_on_segment"),
    row(kEmptyDomain, "EMPTY_DOMAIN", INVALID_ARGUMENT, kFinal, "empty_domain"),
    row(kBadOption, "BAD_OPTION", INVALID_ARGUMENT, kFinal, "bad_option"),
    row(kExpressionSyntax, "EXPRESSION_SYNTAX", INVALID_ARGUMENT, kFinal, "expression_syntax"),
    row(kExpressionTooComplex, "EXPRESSION_TOO_COMPLEX", INVALID_ARGUMENT, kFinal,
        "expression_too_complex"),
    row(kBadSizeValue, "BAD_SIZE_VALUE", INVALID_ARGUMENT, kFinal, "bad_size_value"),
    row(kLimitExceeded, "LIMIT_EXCEEDED", RESOURCE_EXHAUSTED, kFinal, "limit_exceeded"),
    row(kBudgetExceeded, "BUDGET_EXCEEDED", RESOURCE_EXHAUSTED, kFinal, "budget_exceeded"),
    row(kOutOfMemory, "OUT_OF_MEMORY", RESOURCE_EXHAUSTED, kRetry, "out_of_memory"),
    row(kDeadlineExceeded, "DEADLINE_EXCEEDED", DEADLINE_EXCEEDED, kFinal, "deadline_exceeded"),
    row(kCancelled, "CANCELLED", CANCELLED, kFinal, "cancelled"),
    row(kBoundsNotMet, "BOUNDS_NOT_MET", FAILED_PRECONDITION, kFinal, "bounds_not_met"),
    row(kInternal, "INTERNAL", INTERNAL, kFinal, "internal"),
    row(kMalformedRequest, "MALFORMED_REQUEST", INVALID_ARGUMENT, kFinal, "malformed_request"),
    row(kBadArray, "BAD_ARRAY", INVALID_ARGUMENT, kFinal, "bad_array"),
    row(kQueueFull, "QUEUE_FULL", RESOURCE_EXHAUSTED, kRetry, "queue_full"),
    row(kStopping, "STOPPING", UNAVAILABLE, kRetry, "stopping"),
    row(kReaderStalled, "READER_STALLED", CANCELLED, kFinal, "reader_stalled"),
    row(kChunkOutOfRange, "CHUNK_OUT_OF_RANGE", OUT_OF_RANGE, kFinal, "chunk_out_of_range"),
    row(kUnauthenticated, "UNAUTHENTICATED", UNAUTHENTICATED, kFinal, "unauthenticated"),
    row(kNoSuchJob, "NO_SUCH_JOB", NOT_FOUND, kFinal, "no_such_job"),
    row(kMeshGone, "MESH_GONE", NOT_FOUND, kFinal, "mesh_gone"),
    row(kJobNotDone, "JOB_NOT_DONE", FAILED_PRECONDITION, kFinal, "job_not_done"),
    row(kRequestIdReused, "REQUEST_ID_REUSED", ALREADY_EXISTS, kFinal, "request_id_reused"),
    row(kStoreUnavailable, "STORE_UNAVAILABLE", UNAVAILABLE, kRetry, "store_unavailable"),
    row(kStoreFull, "STORE_FULL", RESOURCE_EXHAUSTED, kRetry, "store_full"),
    row(kStoreBroken, "STORE_BROKEN", DATA_LOSS, kFinal, "store_broken"),
    row(kWorkersLost, "WORKERS_LOST", ABORTED, kFinal, "workers_lost"),
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

// The message travels three times, once percent-encoded and twice in base64: six times its bytes
// at worst, in trailers of at most 8 KiB.
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
  return {reason_of(error.code), error.field, error.message};
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
  if (!job_id.empty()) (*info.mutable_metadata())["job_id"] = std::string(job_id);
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

// SPDX-License-Identifier: Apache-2.0
#include "wire/errors.h"

#include <array>
#include <charconv>
#include <protozero/pbf_writer.hpp>

namespace weft::wire {
namespace {

using protozero::pbf_writer;

constexpr bool kRetry = true;
constexpr bool kFinal = false;

// google.rpc.Code, of those that the table has.
enum Code {
  CANCELLED = 1,
  INVALID_ARGUMENT = 3,
  DEADLINE_EXCEEDED = 4,
  NOT_FOUND = 5,
  ALREADY_EXISTS = 6,
  RESOURCE_EXHAUSTED = 8,
  FAILED_PRECONDITION = 9,
  ABORTED = 10,
  OUT_OF_RANGE = 11,
  INTERNAL = 13,
  UNAVAILABLE = 14,
  DATA_LOSS = 15,
  UNAUTHENTICATED = 16,
};

using enum Reason;

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
static_assert(static_cast<int>(ErrorCode::kBadArray) == static_cast<int>(kBadArray));

constexpr std::int64_t kRetrySeconds = 1;

// The shortest decimal that reads back as the same number.
std::string text(double value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

void add_metadata(pbf_writer& info, std::string_view key, std::string_view value) {
  pbf_writer entry(info, 3);
  entry.add_string(1, key.data(), key.size());
  entry.add_string(2, value.data(), value.size());
}

// Adds one of Status.details, a google.protobuf.Any.
void add_detail(pbf_writer& status, const char* type, const std::string& bytes) {
  pbf_writer any(status, 3);
  any.add_string(1, std::string("type.googleapis.com/google.rpc.") + type);
  any.add_bytes(2, bytes);
}

std::string error_info(const Failure& failure, std::string_view name, std::string_view job_id) {
  std::string bytes;
  pbf_writer info(bytes);
  info.add_string(1, name.data(), name.size());
  info.add_string(2, "weft");
  if (!job_id.empty()) add_metadata(info, "job_id", job_id);
  if (failure.at) {
    add_metadata(info, "x", text(failure.at->x));
    add_metadata(info, "y", text(failure.at->y));
  }
  return bytes;
}

std::string bad_request(const Failure& failure) {
  std::string bytes;
  pbf_writer bad(bytes);
  pbf_writer violation(bad, 1);
  violation.add_string(1, failure.field);
  violation.add_string(2, failure.message);
  return bytes;
}

std::string retry_info() {
  std::string bytes;
  pbf_writer retry(bytes);
  pbf_writer delay(retry, 1);
  delay.add_int64(1, kRetrySeconds);
  return bytes;
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

Failure failure_of(const Error& error) {
  return {reason_of(error.code), error.field, error.message, error.at};
}

std::string cut(std::string message, std::size_t max_bytes) {
  if (message.size() <= max_bytes) return message;
  std::size_t end = max_bytes;
  const auto continues = [&](std::size_t i) {
    return (static_cast<unsigned char>(message[i]) & 0xc0) == 0x80;
  };
  while (end > 0 && continues(end)) --end;
  message.resize(end);
  return message + "...";
}

std::string write_status(const Failure& failure, std::string_view job_id) {
  const ErrorRow& row = row_of(failure.reason);
  std::string bytes;
  pbf_writer status(bytes);
  status.add_int32(1, row.code);
  status.add_string(2, failure.message);
  add_detail(status, "ErrorInfo", error_info(failure, row.name, job_id));
  if (!failure.field.empty()) add_detail(status, "BadRequest", bad_request(failure));
  if (row.retryable) add_detail(status, "RetryInfo", retry_info());
  return bytes;
}

}  // namespace weft::wire

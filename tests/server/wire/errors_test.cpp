// SPDX-License-Identifier: Apache-2.0
#include "server/wire/errors.h"

#include <gtest/gtest.h>

#include <set>

#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace weft::server {
namespace {

TEST(ErrorTable, NamesAreUnique) {
  std::set<std::string_view> names;
  for (const ErrorRow& row : error_table()) EXPECT_TRUE(names.insert(row.name).second) << row.name;
}

TEST(ErrorTable, TellsBadRequestsFromLimitsAndFromOurOwnFaults) {
  EXPECT_EQ(row_of(reason_of(ErrorCode::kBadCoordinate)).code, grpc::INVALID_ARGUMENT);
  EXPECT_EQ(row_of(reason_of(ErrorCode::kBadSizeValue)).code, grpc::INVALID_ARGUMENT);
  EXPECT_EQ(row_of(reason_of(ErrorCode::kLimitExceeded)).code, grpc::RESOURCE_EXHAUSTED);
  EXPECT_EQ(row_of(reason_of(ErrorCode::kBudgetExceeded)).code, grpc::RESOURCE_EXHAUSTED);
  EXPECT_EQ(row_of(reason_of(ErrorCode::kOutOfMemory)).code, grpc::RESOURCE_EXHAUSTED);
  EXPECT_EQ(row_of(reason_of(ErrorCode::kDeadlineExceeded)).code, grpc::DEADLINE_EXCEEDED);
  EXPECT_EQ(row_of(reason_of(ErrorCode::kCancelled)).code, grpc::CANCELLED);
  EXPECT_EQ(row_of(reason_of(ErrorCode::kBoundsNotMet)).code, grpc::FAILED_PRECONDITION);
  EXPECT_FALSE(row_of(reason_of(ErrorCode::kBoundsNotMet)).retryable);
  EXPECT_EQ(row_of(reason_of(ErrorCode::kBoundsNotMet)).name, "BOUNDS_NOT_MET");
  EXPECT_EQ(row_of(reason_of(ErrorCode::kInternal)).code, grpc::INTERNAL);
}

TEST(ErrorTable, TellsTheJobsOwnBudgetFromTheMachinesMemory) {
  EXPECT_FALSE(row_of(Reason::kBudgetExceeded).retryable);
  EXPECT_TRUE(row_of(Reason::kOutOfMemory).retryable);
}

google::rpc::ErrorInfo info_of(const Failure& failure, std::string_view job_id) {
  google::rpc::Status details;
  google::rpc::ErrorInfo info;
  EXPECT_TRUE(details.ParseFromString(to_status(failure, job_id).error_details()));
  EXPECT_TRUE(details.details_size() > 0 && details.details(0).UnpackTo(&info));
  return info;
}

TEST(ToStatus, GivesThePlaceAtFaultExactly) {
  const Error error{ErrorCode::kBadSizeValue, "size", "the size is 0", Point{0.1, -2e-30}};
  const auto metadata = info_of(failure_of(error), "job-1").metadata();
  EXPECT_EQ(metadata.at("x"), "0.1");
  EXPECT_EQ(metadata.at("y"), "-2e-30");
  EXPECT_EQ(metadata.at("job_id"), "job-1");
}

TEST(ToStatus, OfNoPlaceHasNoCoordinates) {
  EXPECT_TRUE(info_of({Reason::kBadOption, "threads", "no"}, "").metadata().empty());
}

TEST(CodeName, IsTheNameThatGrpcGivesTheCode) {
  EXPECT_EQ(code_name(grpc::OK), "OK");
  EXPECT_EQ(code_name(grpc::RESOURCE_EXHAUSTED), "RESOURCE_EXHAUSTED");
  EXPECT_EQ(code_name(grpc::UNAVAILABLE), "UNAVAILABLE");
  EXPECT_EQ(code_name(grpc::UNAUTHENTICATED), "UNAUTHENTICATED");
}

}  // namespace
}  // namespace weft::server

// SPDX-License-Identifier: Apache-2.0
#include "server/wire/errors.h"

#include <cstddef>

#include "google/rpc/code.pb.h"

namespace weft::server {
namespace {

// A message travels three times, once percent-encoded and twice in base64: at worst six times its
// bytes, in trailers of at most 8 KiB.
constexpr std::size_t kMaxMessageBytes = 1000;

}  // namespace

grpc::StatusCode code_of(Reason reason) {
  return static_cast<grpc::StatusCode>(row_of(reason).code);
}

std::string_view code_name(grpc::StatusCode code) {
  return google::rpc::Code_Name(static_cast<google::rpc::Code>(code));
}

grpc::Status to_status(Failure failure, std::string_view job_id) {
  failure.message = wire::cut(std::move(failure.message), kMaxMessageBytes);
  return {code_of(failure.reason), failure.message, wire::write_status(failure, job_id)};
}

}  // namespace weft::server

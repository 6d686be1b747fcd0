// SPDX-License-Identifier: Apache-2.0
// What a server's status means to the user: the exit code 64 + gRPC code, and a message with the
// reason (google.rpc.ErrorInfo), the field at fault (BadRequest) and, where that field came from a
// file, the place in the file.
#pragma once

#include <grpcpp/support/status.h>

#include <string>

#include "client/base/error.h"
#include "client/formats/domain.h"
#include "google/rpc/status.pb.h"

namespace weft::client {

// REQUIRES: the status is not OK. `domain` may be null.
Error error_of(const grpc::Status& status, const std::string& address, const Domain* domain);

// The same for a status that is told in a message, as Job.error is. `subject` says whose it is:
// "the job 01J... failed with". A code that is no error gives kInternal.
Error error_of(const google::rpc::Status& status, const std::string& subject, const Domain* domain);

// "RESOURCE_EXHAUSTED (QUEUE_FULL)": the code, and the reason where there is one.
std::string reason_of(const google::rpc::Status& status);

// What a call ended with, and the details that came along.
google::rpc::Status rich_status(const grpc::Status& status);

// Where the file has what `field` names, as in "domain.segments[17].b"; empty when it does not say.
std::string locate_field(const std::string& field, const Domain& domain);

}  // namespace weft::client

// SPDX-License-Identifier: Apache-2.0
// Converts a server's status to an error for the user: the exit code 64 + gRPC code, and a message
// with the reason (google.rpc.ErrorInfo), the field at fault (BadRequest) and, if that field came
// from a file, the place in the file.
#pragma once

#include <grpcpp/support/status.h>

#include <string>

#include "client/base/error.h"
#include "client/formats/domain.h"
#include "google/rpc/status.pb.h"

namespace weft::client {

// REQUIRES: the status is not OK. `domain` may be null.
Error error_of(const grpc::Status& status, const std::string& address, const Domain* domain);

// The same for a status in a message, such as Job.error. `subject` says whose it is:
// "the job 01J... failed with". A code that is not an error gives kInternal.
Error error_of(const google::rpc::Status& status, const std::string& subject, const Domain* domain);

// "RESOURCE_EXHAUSTED (QUEUE_FULL)": the code, and the reason if there is one.
std::string reason_of(const google::rpc::Status& status);

// The status of a call, with its details.
google::rpc::Status rich_status(const grpc::Status& status);

// The place in the file of what `field` names, as in "domain.segments[17].b"; empty if unknown.
std::string locate_field(const std::string& field, const Domain& domain);

}  // namespace weft::client

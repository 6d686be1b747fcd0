// SPDX-License-Identifier: Apache-2.0
// Converts a server's status to an error for the user: the exit code 64 + gRPC code, and a message
// with the reason (google.rpc.ErrorInfo) and what is at fault: the option that set the field of the
// BadRequest, or this field and, if it came from a file, the place in the file.
#pragma once

#include <grpcpp/support/status.h>

#include <string>

#include "client/call/mesh_request.h"
#include "files/base/error.h"
#include "files/formats/domain.h"
#include "files/geo/domain_projection.h"
#include "google/rpc/status.pb.h"

namespace weft::client {

// What a request was made of, as far as it is known; otherwise null.
struct RequestOrigin {
  const Domain* domain = nullptr;
  const RequestOptions* options = nullptr;
  const DomainProjection* projection = nullptr;  // of the domain, for places in the plane
};

// REQUIRES: the status is not OK.
Error error_of(const grpc::Status& status, const std::string& address,
               const RequestOrigin& origin = {});

// The same for a status in a message, such as Job.error. `subject` says whose it is:
// "the job 01J... failed with". A code that is not an error gives kInternal.
Error error_of(const google::rpc::Status& status, const std::string& subject,
               const RequestOrigin& origin = {});

// "RESOURCE_EXHAUSTED (QUEUE_FULL)": the code, and the reason if there is one.
std::string reason_of(const google::rpc::Status& status);

// The status of a call, with its details.
google::rpc::Status rich_status(const grpc::Status& status);

}  // namespace weft::client

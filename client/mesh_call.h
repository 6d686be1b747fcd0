// SPDX-License-Identifier: Apache-2.0
// The call GenerateMesh: sends a domain and what its mesh must satisfy, and receives the mesh into
// a spool.
//
// Errors: 64 + gRPC status for a refusal or a lost server, kDataLoss for a stream that lies,
// kUnwritableOutput when the spool fails; after any of them the call is cancelled. A stop that is
// asked for cancels the call, too.
//
// Where a server that the user named goes away (UNAVAILABLE) in the middle of the mesh, the call is
// made once more, for the chunks that are missing, as soon as the server is back, within 5 s. It
// must be of the same engine version.
#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>

#include "client/connection.h"
#include "client/error.h"
#include "client/formats/domain.h"
#include "client/mesh_report.h"
#include "client/mesh_request.h"
#include "client/mesh_spool.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::client {

struct MeshCallOptions {
  std::optional<double> timeout_seconds{};                 // deadline of the call
  std::function<void(const v1::Progress&)> on_progress{};  // on the calling thread; may be empty
};

Result<MeshReport> call_generate_mesh(const Connection& connection, const Domain& domain,
                                      const MeshWishes& wishes, const MeshCallOptions& options,
                                      MeshSpool& spool, std::stop_token stop);

}  // namespace weft::client

// SPDX-License-Identifier: Apache-2.0
// The call GenerateMesh: sends a domain and what its mesh must satisfy, and receives the mesh into
// a spool.
//
// If a server that the user named goes away, or is busy, the call is repeated (retry.h), for the
// missing chunks; the server must have the same engine version.
//
// Errors: 64 + gRPC status for a refusal or a lost server, kDataLoss for an inconsistent stream,
// kUnwritableOutput if the spool fails; after any of them the call is cancelled. A requested stop
// cancels the call, too.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>

#include "client/call/connection.h"
#include "client/call/mesh_report.h"
#include "client/call/mesh_request.h"
#include "client/call/retry.h"
#include "files/base/error.h"
#include "files/formats/domain.h"
#include "files/geo/domain_projection.h"
#include "files/message/mesh_spool.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::client {

struct MeshCallOptions {
  std::optional<double> timeout_seconds{};  // of the call, with all its retries
  std::uint32_t retries = RetryOptions{}.attempts;
  std::function<void(const v1::Progress&)> on_progress{};  // on the calling thread; may be empty
  // Called when the server is away, once for several failures in a row. DEFAULT: a line on stderr.
  std::function<void(const std::string&)> on_away{};
  // Of the domain, for places in errors; null if the domain is sent as its file has it.
  const DomainProjection* projection = nullptr;
};

Result<MeshReport> call_generate_mesh(const Connection& connection, const Domain& domain,
                                      const RequestOptions& request_options,
                                      const MeshCallOptions& options, MeshSpool& spool,
                                      std::stop_token stop);

}  // namespace weft::client

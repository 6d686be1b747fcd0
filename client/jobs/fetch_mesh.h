// SPDX-License-Identifier: Apache-2.0
// Downloads the mesh of a job that succeeded into a spool. A stream that breaks is taken up by
// another one at the chunk where it broke, as often as a chunk comes in between (see retry.h).
//
// Errors: as JobServer's; kDataLoss for a stream that lies, kUnwritableOutput when the spool fails.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "client/error.h"
#include "client/jobs/job_server.h"
#include "client/mesh_receiver.h"
#include "client/mesh_report.h"
#include "client/mesh_spool.h"

namespace weft::client {

struct FetchMeshOptions {
  // Of the domain that was submitted. Where it is not known, the input points and segments that a
  // mesh refers to are taken as they come: nothing here is read by their numbers.
  std::optional<DomainCounts> domain{};
  // After every chunk, the triangles so far; may be empty.
  std::function<void(std::uint64_t)> on_triangles{};
};

Result<MeshReport> fetch_mesh(JobServer& server, const std::string& id, MeshSpool& spool,
                              const FetchMeshOptions& options);

}  // namespace weft::client

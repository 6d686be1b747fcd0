// SPDX-License-Identifier: Apache-2.0
// Downloads the mesh of a job that succeeded into a spool (mesh_download.h).
//
// Errors: as JobServer's; kDataLoss for an inconsistent stream, kUnwritableOutput if the spool
// fails.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "client/call/job_server.h"
#include "client/call/mesh_receiver.h"
#include "client/call/mesh_report.h"
#include "files/base/error.h"
#include "files/message/mesh_spool.h"

namespace weft::client {

struct FetchMeshOptions {
  // Of the submitted domain. If it is not known, references to input points and segments are not
  // checked: nothing here is indexed by them.
  std::optional<DomainCounts> domain{};
  // After every chunk, the triangles so far; may be empty.
  std::function<void(std::uint64_t)> on_triangles{};
};

Result<MeshReport> fetch_mesh(JobServer& server, const std::string& id, MeshSpool& spool,
                              const FetchMeshOptions& options);

}  // namespace weft::client

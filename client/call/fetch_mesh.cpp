// SPDX-License-Identifier: Apache-2.0
#include "client/call/fetch_mesh.h"

#include <utility>

#include "client/call/mesh_download.h"

namespace weft::client {

Result<MeshReport> fetch_mesh(JobServer& server, const std::string& id, MeshSpool& spool,
                              const FetchMeshOptions& options) {
  MeshReceiver receiver(spool, options.domain);
  v1::FetchMeshRequest request;
  request.set_id(id);
  auto download = download_mesh<v1::FetchMeshResponse>(
      receiver, server.retry(), server.deadline(), server.stop(),
      [&](grpc::ClientContext* context, std::uint32_t first_chunk) {
        request.set_first_chunk(first_chunk);
        return server.stub().FetchMesh(context, request);
      },
      [&](const v1::FetchMeshResponse& message) {
        if (message.has_chunk() && options.on_triangles) options.on_triangles(spool.triangles());
      });
  if (!download) return tl::unexpected(download.error());
  if (!download->status.ok()) return tl::unexpected(server.error_of(download->status));
  return std::move(download->report);
}

}  // namespace weft::client

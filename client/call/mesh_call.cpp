// SPDX-License-Identifier: Apache-2.0
#include "client/call/mesh_call.h"

#include <utility>

#include "client/call/connection_retry.h"
#include "client/call/mesh_download.h"
#include "client/call/mesh_receiver.h"
#include "client/call/server_error.h"
#include "weft/v1/mesh_service.grpc.pb.h"

namespace weft::client {

Result<MeshReport> call_generate_mesh(const Connection& connection, const Domain& domain,
                                      const RequestOptions& request_options,
                                      const MeshCallOptions& options, MeshSpool& spool,
                                      std::stop_token stop) {
  if (auto ok = check_sendable(domain); !ok) return tl::unexpected(ok.error());
  v1::MeshService::Stub stub(connection.channel);
  v1::GenerateMeshRequest request = make_request(domain, request_options);
  MeshReceiver receiver(spool, DomainCounts{domain.points.size(), domain.segments.size()});
  const std::optional<Deadline> deadline = deadline_after(options.timeout_seconds);
  auto download = download_mesh<v1::GenerateMeshResponse>(
      receiver,
      retry_on(connection,
               {.attempts = options.retries, .deadline = deadline, .on_away = options.on_away},
               stop),
      deadline, stop,
      [&](grpc::ClientContext* context, std::uint32_t first_chunk) {
        request.set_first_chunk(first_chunk);
        return stub.GenerateMesh(context, request);
      },
      [&](const v1::GenerateMeshResponse& message) {
        if (message.has_progress() && options.on_progress) options.on_progress(message.progress());
      });
  if (!download) return tl::unexpected(download.error());
  if (!download->status.ok())
    return tl::unexpected(error_of(download->status, connection.address,
                                   {&domain, &request_options, options.projection}));
  return std::move(download->report);
}

}  // namespace weft::client

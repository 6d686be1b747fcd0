// SPDX-License-Identifier: Apache-2.0
#include "client/jobs/fetch_mesh.h"

#include <chrono>

namespace weft::client {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

Result<MeshReport> fetch_mesh(JobServer& server, const std::string& id, MeshSpool& spool,
                              const FetchMeshOptions& options) {
  const Clock::time_point start = Clock::now();
  MeshReceiver receiver(spool, options.domain);
  MeshReport report;
  Retry retry = server.retry();
  for (;;) {
    v1::FetchMeshRequest request;
    request.set_id(id);
    request.set_first_chunk(receiver.chunks());
    if (receiver.accepted()) receiver.resume();
    JobServer::Attempt attempt(server);
    const auto stream = server.stub().FetchMesh(&attempt.context(), request);
    v1::FetchMeshResponse message;
    Result<void> sound;
    while (sound && stream->Read(&message)) {
      sound = receiver.receive(message);
      if (!sound || !message.has_chunk()) continue;
      retry.restart();
      if (report.first_chunk_seconds == 0) report.first_chunk_seconds = seconds_since(start);
      if (options.on_triangles) options.on_triangles(spool.triangles());
    }
    if (!sound) {
      attempt.context().TryCancel();
      while (stream->Read(&message)) continue;
      stream->Finish();
      return tl::unexpected(sound.error());
    }
    const grpc::Status status = stream->Finish();
    // What follows the summary does not matter: the mesh is whole.
    if (status.ok() || receiver.summary()) break;
    if (!retry.again(status)) return tl::unexpected(server.error_of(status, nullptr));
  }
  if (auto complete = receiver.finish(); !complete) return tl::unexpected(complete.error());
  report.stream_seconds = seconds_since(start);
  report.accepted = *receiver.accepted();
  report.summary = *receiver.summary();
  report.bytes_received = receiver.bytes();
  return report;
}

}  // namespace weft::client

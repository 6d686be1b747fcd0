// SPDX-License-Identifier: Apache-2.0
// `weft server-info`: what the server is and what it admits.
#include <grpcpp/client_context.h>

#include <chrono>
#include <cstdio>

#include "client/call/connection.h"
#include "client/call/server_error.h"
#include "client/commands/commands.h"
#include "files/base/text.h"
#include "weft/v1/mesh_service.grpc.pb.h"

namespace weft::client {

Result<ExitCode> run_server_info(const ServerOptions& options, std::stop_token stop) {
  const auto connection = connect(options.server, stop);
  if (!connection) return tl::unexpected(connection.error());
  const auto stub = v1::MeshService::NewStub(connection->channel);
  grpc::ClientContext context;
  context.set_deadline(
      std::chrono::system_clock::now() +
      std::chrono::milliseconds(static_cast<std::int64_t>(options.timeout_seconds * 1000)));
  const std::stop_callback cancel(stop, [&context] { context.TryCancel(); });
  v1::GetServerInfoResponse info;
  const grpc::Status status = stub->GetServerInfo(&context, {}, &info);
  if (!status.ok()) return tl::unexpected(error_of(status, connection->address));

  std::string text;
  const auto row = [&text](const char* name, const std::string& value) {
    char label[40];
    std::snprintf(label, sizeof label, "%-22s ", name);
    text += label + value + "\n";
  };
  const v1::ServerLimits& limits = info.limits();
  row("version", info.version());
  row("engine version", info.engine_version());
  row("threads", std::to_string(info.threads()));
  row("most points", with_separators(limits.max_points()));
  row("most segments", with_separators(limits.max_segments()));
  row("most seeds", with_separators(limits.max_seeds()));
  row("longest expression", with_separators(limits.max_expression_bytes()) + " bytes");
  row("largest size raster", with_separators(limits.max_raster_values()) + " values");
  row("most triangles", with_separators(limits.max_triangles()));
  row("most engine memory", with_separators(limits.max_bytes()) + " bytes");
  row("longest run", shortest(limits.max_seconds()) + " s");
  row("largest request", with_separators(limits.max_request_bytes()) + " bytes");
  row("runs at a time", std::to_string(limits.max_concurrent_jobs()));
  row("waiting calls", with_separators(limits.max_waiting_calls()));
  row("memory for runs", with_separators(limits.max_admitted_bytes()) + " bytes");
  row("patience with readers", shortest(limits.stall_seconds()) + " s");
  row("largest minimum angle", shortest(limits.max_min_angle_deg()) + " degrees");
  if (!info.has_jobs()) return print(text);
  const v1::JobLimits& jobs = info.jobs();
  row("queued meshes", with_separators(jobs.max_queued()));
  row("  open, of one client", with_separators(jobs.max_queued_per_client()));
  row("attempts at a mesh", std::to_string(jobs.max_attempts()));
  row("lease of a worker", shortest(jobs.lease_seconds()) + " s");
  row("meshes are kept", shortest(jobs.keep_seconds()) + " s");
  row("most kept", with_separators(jobs.keep_bytes()) + " bytes");
  if (jobs.keep_jobs_per_client() > 0)
    row("  ended, of one client", with_separators(jobs.keep_jobs_per_client()));
  return print(text);
}

}  // namespace weft::client

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/stream_bench.h"

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>

#include "bench/models.h"
#include "bench/requests.h"
#include "bench/weftd_process.h"
#include "tests/support/poly.h"
#include "weft/v1/mesh_service.grpc.pb.h"

namespace weft::bench {
namespace {

using Clock = std::chrono::steady_clock;

struct Received {
  double first_triangles_seconds = 0;  // from sending the request
  double seconds = 0;                  // until the last byte
  std::uint64_t bytes = 0;
  v1::Summary summary;
};

std::optional<Received> receive(const std::string& address,
                                const v1::GenerateMeshRequest& request) {
  const auto stub = v1::MeshService::NewStub(connect(address));
  grpc::ClientContext context;
  Received received;
  const auto start = Clock::now();
  const auto since_start = [&] {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  const auto stream = stub->GenerateMesh(&context, request);
  v1::GenerateMeshResponse message;
  while (stream->Read(&message)) {
    received.bytes += message.ByteSizeLong();
    if (message.chunk().triangles_size() > 0 && received.first_triangles_seconds == 0)
      received.first_triangles_seconds = since_start();
    if (message.has_summary()) received.summary = message.summary();
  }
  const grpc::Status status = stream->Finish();
  received.seconds = since_start();
  if (status.ok()) return received;
  std::fprintf(stderr, "%s: %s\n", address.c_str(), status.error_message().c_str());
  return std::nullopt;
}

// The same job in this process, with nobody to send it to.
double engine_seconds_alone(const Pslg& pslg, const std::string& size, int threads, int runs) {
  Arena arena(threads);
  std::vector<double> seconds;
  for (int run = 0; run <= runs; ++run) {
    Discard sink;
    ExecutionContext context;
    context.set_arena(arena);
    const auto start = Clock::now();
    const auto summary = generate_mesh({.pslg = pslg, .size = {.expression = size}}, sink, context);
    if (summary && run > 0)
      seconds.push_back(std::chrono::duration<double>(Clock::now() - start).count());
  }
  return seconds.empty() ? 0 : median(seconds);
}

}  // namespace

int run_stream_bench(const StreamBenchOptions& options) {
  std::printf(
      "| transport | triangles | engine alone s | first triangles s | of total | total s "
      "| total / engine alone | total / engine in the server | MB/s | Mtri/s | server bytes/tri "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  const Pslg pslg = read_poly(options.models + "/cylinder.poly");
  for (const double triangles : options.triangles) {
    const std::string size = cylinder_size(triangles);
    const double alone = engine_seconds_alone(pslg, size, options.threads, options.runs);
    const v1::GenerateMeshRequest request = make_request(pslg, size);
    for (const bool over_tcp : {false, true}) {
      const auto server = WeftdProcess::start(options.weftd, options.threads);
      if (!server) return 1;
      std::vector<double> first;
      std::vector<double> total;
      std::vector<double> in_server;
      std::optional<Received> last;
      for (int run = 0; run <= options.runs; ++run) {
        last = receive(over_tcp ? server->tcp_address() : server->unix_address(), request);
        if (!last) return 1;
        if (run == 0) continue;
        first.push_back(last->first_triangles_seconds);
        total.push_back(last->seconds);
        in_server.push_back(last->summary.timings().engine_seconds());
      }
      const double seconds = median(total);
      const auto count = static_cast<double>(last->summary.triangles());
      std::printf(
          "| %s | %.0f | %.4f | %.4f | %.1f %% | %.4f | %.2f | %.2f | %.0f | %.1f | %.1f |\n",
          over_tcp ? "TCP" : "unix socket", count, alone, median(first),
          100 * median(first) / seconds, seconds, seconds / alone, seconds / median(in_server),
          static_cast<double>(last->bytes) / seconds * 1e-6, count / seconds * 1e-6,
          static_cast<double>(server->peak_bytes()) / count);
      std::fflush(stdout);
    }
  }
  return 0;
}

}  // namespace weft::bench

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/stream_bench.h"

#include <grpcpp/grpcpp.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <thread>

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
  double longest_gap_seconds = 0;      // between two messages with triangles
  double seconds = 0;                  // until the last byte
  double slept_seconds = 0;            // of `seconds`
  std::uint64_t bytes = 0;
  v1::Summary summary;
};

// A reader that sleeps does so for 2 s at a twentieth, a half and nine tenths of the expected
// triangles.
constexpr double kSleepsAt[] = {0.05, 0.5, 0.9};
constexpr std::chrono::seconds kSleep{2};

std::optional<Received> receive(const std::string& address, const v1::GenerateMeshRequest& request,
                                double sleeper_expects) {
  const auto stub = v1::MeshService::NewStub(connect(address));
  grpc::ClientContext context;
  Received received;
  const auto start = Clock::now();
  const auto since_start = [&] {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  const auto stream = stub->GenerateMesh(&context, request);
  v1::GenerateMeshResponse message;
  double triangles = 0;
  double last = 0;
  const double* sleeps_at = sleeper_expects > 0 ? std::begin(kSleepsAt) : std::end(kSleepsAt);
  while (stream->Read(&message)) {
    received.bytes += message.ByteSizeLong();
    if (message.has_summary()) received.summary = message.summary();
    if (message.chunk().triangles_size() == 0) continue;
    const double now = since_start();
    if (triangles == 0) {
      received.first_triangles_seconds = now;
    } else {
      received.longest_gap_seconds = std::max(received.longest_gap_seconds, now - last);
    }
    triangles += message.chunk().triangles_size() / 3;
    if (sleeps_at != std::end(kSleepsAt) && triangles > *sleeps_at * sleeper_expects) {
      std::this_thread::sleep_for(kSleep);
      received.slept_seconds += std::chrono::duration<double>(kSleep).count();
      ++sleeps_at;
    }
    last = since_start();
  }
  const grpc::Status status = stream->Finish();
  received.seconds = since_start();
  if (status.ok()) return received;
  std::fprintf(stderr, "%s: %s\n", address.c_str(), status.error_message().c_str());
  return std::nullopt;
}

// The same request in this process, without a reader.
double engine_seconds_alone(const Pslg& pslg, const std::string& size, int threads, int runs) {
  ThreadPool pool(threads);
  std::vector<double> seconds;
  for (int run = 0; run <= runs; ++run) {
    Discard sink;
    Run mesh_run;
    mesh_run.set_threads(pool);
    const auto start = Clock::now();
    const auto summary = stream({.pslg = pslg, .size = size}, sink, mesh_run);
    if (summary && run > 0)
      seconds.push_back(std::chrono::duration<double>(Clock::now() - start).count());
  }
  return seconds.empty() ? 0 : median(seconds);
}

// A row of the table of transports, in a server of its own.
bool print_transport(const StreamBenchOptions& options, const v1::GenerateMeshRequest& request,
                     bool over_tcp, double alone) {
  const auto server = WeftdProcess::start(options.weftd, options.threads);
  if (!server) return false;
  std::vector<double> first;
  std::vector<double> total;
  std::vector<double> in_server;
  std::optional<Received> last;
  for (int run = 0; run <= options.runs; ++run) {
    last = receive(over_tcp ? server->tcp_address() : server->unix_address(), request, 0);
    if (!last) return false;
    if (run == 0) continue;
    first.push_back(last->first_triangles_seconds);
    total.push_back(last->seconds);
    in_server.push_back(last->summary.timings().engine_seconds());
  }
  const double seconds = median(total);
  const auto count = static_cast<double>(last->summary.triangles());
  std::printf("| %s | %.0f | %.4f | %.4f | %.1f %% | %.4f | %.2f | %.2f | %.0f | %.1f | %.1f |\n",
              over_tcp ? "TCP" : "unix socket", count, alone, median(first),
              100 * median(first) / seconds, seconds, seconds / alone, seconds / median(in_server),
              static_cast<double>(last->bytes) / seconds * 1e-6, count / seconds * 1e-6,
              static_cast<double>(server->peak_bytes()) / count);
  std::fflush(stdout);
  return true;
}

// A row of the table of memory: one run in a server of its own. Returns the number of triangles
// that came, or 0.
double print_memory(const StreamBenchOptions& options, const v1::GenerateMeshRequest& request,
                    double sleeper_expects) {
  const auto server = WeftdProcess::start(options.weftd, options.threads);
  if (!server) return 0;
  const auto got = receive(server->unix_address(), request, sleeper_expects);
  if (!got) return 0;
  const double seconds = got->seconds - got->slept_seconds;
  const auto count = static_cast<double>(got->summary.triangles());
  const auto bytes = static_cast<double>(server->peak_bytes());
  std::printf("| %s | %.0f | %.2f | %.2f | %.2f %% | %.2f %% | %.0f | %.2f |\n",
              sleeper_expects > 0 ? "sleeps" : "keeps up", count, got->seconds,
              count / seconds * 1e-6, 100 * got->first_triangles_seconds / seconds,
              100 * got->longest_gap_seconds / seconds, bytes * 1e-6, bytes / count);
  std::fflush(stdout);
  return count;
}

}  // namespace

int run_stream_bench(const StreamBenchOptions& options) {
  const Pslg pslg = read_poly(options.models + "/cylinder.poly");
  if (options.memory) {
    std::printf(
        "| reader | triangles | total s | Mtri/s | first triangles | longest gap | server MB "
        "| bytes/tri |\n|---|---|---|---|---|---|---|---|\n");
    for (const double triangles : options.triangles) {
      const v1::GenerateMeshRequest request = make_request(pslg, cylinder_size(triangles));
      const double count = print_memory(options, request, 0);
      if (count == 0 || print_memory(options, request, count) == 0) return 1;
    }
    return 0;
  }
  std::printf(
      "| transport | triangles | engine alone s | first triangles s | of total | total s "
      "| total / engine alone | total / engine in the server | MB/s | Mtri/s | server bytes/tri "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const double triangles : options.triangles) {
    const std::string size = cylinder_size(triangles);
    const double alone = engine_seconds_alone(pslg, size, options.threads, options.runs);
    const v1::GenerateMeshRequest request = make_request(pslg, size);
    for (const bool over_tcp : {false, true})
      if (!print_transport(options, request, over_tcp, alone)) return 1;
  }
  return 0;
}

}  // namespace weft::bench

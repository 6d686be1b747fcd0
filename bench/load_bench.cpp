// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/load_bench.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <thread>
#include <vector>

#include "bench/models.h"
#include "bench/requests.h"
#include "bench/weftd_process.h"
#include "tests/support/poly.h"
#include "weft/v1/job_service.grpc.pb.h"
#include "weft/v1/mesh_service.grpc.pb.h"

namespace weft::bench {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// The grading of the pipe in the paper.
constexpr const char* kPipeSize = "0.4*hypot(x-200, y-200) + 1";

// Returns false if the call failed.
bool mesh_once(v1::MeshService::Stub& stub, const v1::GenerateMeshRequest& request) {
  grpc::ClientContext context;
  const auto stream = stub.GenerateMesh(&context, request);
  v1::GenerateMeshResponse message;
  while (stream->Read(&message)) continue;
  const grpc::Status status = stream->Finish();
  if (!status.ok()) std::fprintf(stderr, "%s\n", status.error_message().c_str());
  return status.ok();
}

// Makes calls one after the other, on a connection of its own, until it is told to stop.
class Caller {
 public:
  Caller(const std::string& address, const v1::GenerateMeshRequest& request,
         const std::atomic<bool>& stop)
      : thread_([this, address, &request, &stop] {
          const auto stub = v1::MeshService::NewStub(connect(address));
          while (!stop && ok_) {
            const auto start = Clock::now();
            ok_ = mesh_once(*stub, request);
            latencies_.push_back(seconds_since(start));
          }
        }) {}
  // The seconds of each call; empty if one failed.
  std::optional<std::vector<double>> join() {
    thread_.join();
    if (!ok_) return std::nullopt;
    return std::move(latencies_);
  }

 private:
  std::vector<double> latencies_;
  bool ok_ = true;
  std::thread thread_;  // last, because it uses the members above
};

// Makes `small` requests on so many connections while as many others make `large` ones.
bool print_row(const char* name, const std::string& address, const v1::GenerateMeshRequest& small,
               int connections, const v1::GenerateMeshRequest& large, int large_connections,
               double seconds) {
  std::atomic<bool> stop{false};
  std::vector<std::unique_ptr<Caller>> background;
  for (int i = 0; i < large_connections; ++i)
    background.push_back(std::make_unique<Caller>(address, large, stop));
  std::vector<std::unique_ptr<Caller>> callers;
  const auto start = Clock::now();
  for (int i = 0; i < connections; ++i)
    callers.push_back(std::make_unique<Caller>(address, small, stop));
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  stop = true;
  std::vector<double> latencies;
  bool ok = true;
  for (const auto& caller : callers) {
    const auto own = caller->join();
    ok &= own.has_value();
    if (own) latencies.insert(latencies.end(), own->begin(), own->end());
  }
  const double took = seconds_since(start);
  std::size_t large_calls = 0;
  for (const auto& caller : background) {
    const auto own = caller->join();
    ok &= own.has_value();
    if (own) large_calls += own->size();
  }
  if (!ok || latencies.empty()) return false;
  std::sort(latencies.begin(), latencies.end());
  const auto at = [&](double share) {
    return 1e3 *
           latencies[static_cast<std::size_t>(share * static_cast<double>(latencies.size() - 1))];
  };
  std::printf("| %s | %d | %.0f | %.2f | %.2f | %.2f | %.2f |\n", name, connections,
              static_cast<double>(latencies.size()) / took, at(0.5), at(0.99), at(1),
              static_cast<double>(large_calls) / took);
  std::fflush(stdout);
  return true;
}

bool wait_until_done(v1::JobService::Stub& stub, const std::string& id) {
  grpc::ClientContext context;
  v1::WatchJobRequest request;
  request.set_id(id);
  const auto stream = stub.WatchJob(&context, request);
  v1::WatchJobResponse message;
  while (stream->Read(&message)) continue;
  return stream->Finish().ok() && message.job().state() == v1::JOB_STATE_SUCCEEDED;
}

// Asks for a mesh in the store again; its bytes are not parsed.
bool print_fetches(const char* transport, const std::string& address,
                   const v1::GenerateMeshRequest& mesh) {
  const auto channel = connect(address);
  const auto stub = v1::JobService::NewStub(channel);
  std::vector<double> seconds;
  std::uint64_t bytes = 0;
  double refined = 0;
  for (int run = 0; run < 6; ++run) {
    const auto start = Clock::now();
    v1::SubmitJobRequest request;
    *request.mutable_mesh() = mesh;
    v1::SubmitJobResponse submitted;
    {
      grpc::ClientContext context;
      if (!stub->SubmitJob(&context, request, &submitted).ok()) return false;
    }
    if (!wait_until_done(*stub, submitted.job().id())) return false;
    if (run == 0) {
      refined = seconds_since(start);
      continue;
    }
    grpc::ClientContext context;
    v1::FetchMeshRequest fetch;
    fetch.set_id(submitted.job().id());
    const auto stream = stub->FetchMesh(&context, fetch);
    v1::FetchMeshResponse message;
    bytes = 0;
    while (stream->Read(&message)) bytes += message.ByteSizeLong();
    if (!stream->Finish().ok()) return false;
    seconds.push_back(seconds_since(start));
  }
  std::printf("| %s | %.1f | %.3f | %.3f | %.2f |\n", transport, static_cast<double>(bytes) * 1e-6,
              refined, median(seconds), static_cast<double>(bytes) / median(seconds) * 1e-9);
  std::fflush(stdout);
  return true;
}

}  // namespace

int run_load_bench(const LoadBenchOptions& options) {
  const auto server = WeftdProcess::start(options.weftd, options.threads);
  if (!server) return 1;
  const auto small = make_request(read_poly(options.models + "/pipe.poly"), kPipeSize);
  const Pslg cylinder = read_poly(options.models + "/cylinder.poly");
  const auto large = make_request(cylinder, cylinder_size(1e6));
  std::printf(
      "| pipe requests | connections | requests/s | p50 ms | p99 ms | max ms | jobs of 1 M "
      "triangles/s |\n|---|---|---|---|---|---|---|\n");
  const std::string& address = server->unix_address();
  auto repeated = small;
  repeated.set_no_cache(false);
  if (!print_row("the same again", address, repeated, 1, large, 0, options.seconds) ||
      !print_row("the same again", address, repeated, options.connections, large, 0,
                 options.seconds) ||
      !print_row("alone", address, small, 1, large, 0, options.seconds) ||
      !print_row("alone", address, small, options.connections, large, 0, options.seconds) ||
      !print_row("beside 1 M jobs, 8 at a time", address, small, 1, large, 8, options.seconds) ||
      !print_row("beside 1 M jobs, 8 at a time", address, small, options.connections, large, 8,
                 options.seconds))
    return 1;
  std::printf("\n| from the store | MB | first time s | again s | GB/s |\n|---|---|---|---|---|\n");
  auto stored = make_request(cylinder, cylinder_size(1e7));
  stored.set_no_cache(false);
  return print_fetches("unix socket", server->unix_address(), stored) &&
                 print_fetches("TCP", server->tcp_address(), stored)
             ? 0
             : 1;
}

}  // namespace weft::bench

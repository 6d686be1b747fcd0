// SPDX-License-Identifier: Apache-2.0
// One hostile client of each kind, all at once, each on connections of its own:
//
//   build/release/hostile_clients HOST:PORT SECONDS [tcp|tls [KIND...]]
//
// KIND is one of kinds.h, which speak no TLS, or of floods.h; without any, all of kinds.h.
// Those that the server is to know send the token `the-token-of-KIND`. Prints how often each did
// what it does. A process of its own: what hostile clients compute, they compute on other machines,
// so here they take what the server and honest clients leave.
#include <grpcpp/client_context.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "tests/e2e/fleet.h"
#include "tests/e2e/hostile/floods.h"
#include "tests/e2e/hostile/http2_client.h"
#include "tests/e2e/hostile/kinds.h"
#include "tests/server/raw_call.h"
#include "weft/v1/job_service.grpc.pb.h"
#include "weft/v1/mesh_service.grpc.pb.h"

namespace weft::e2e {
namespace {

using server::testing::raw_unary;
using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;

std::atomic<bool> over{false};

v1::GenerateMeshRequest square(const std::string& size) {
  v1::GenerateMeshRequest request;
  request.set_no_cache(true);
  for (const double x : {0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0})
    request.mutable_domain()->add_points(x);
  for (const std::uint32_t i : {0u, 1u, 1u, 2u, 2u, 3u, 3u, 0u})
    request.mutable_domain()->add_segments(i);
  request.mutable_size()->set_expression(size);
  return request;
}

// A server that knows the token of this kind.
struct Victim {
  std::string address;  // TCP
  std::string kind;
};

std::string repeated(std::string_view part, std::size_t bytes) {
  std::string all;
  all.reserve(bytes + part.size());
  while (all.size() < bytes) all += part;
  return all;
}

void send_unknown_fields(const Victim& target, const std::string& authorization) {
  const std::string junk = repeated("\x7b\x7c", 8 * kMiB);
  const auto channel = connect(target.address);
  for (const char* method :
       {"/weft.v1.MeshService/GenerateMesh", "/weft.v1.MeshService/GetServerInfo",
        "/weft.v1.JobService/SubmitJob", "/weft.v1.JobService/GetJob"})
    (void)raw_unary(channel, method, junk, authorization);
}
void send_unknown_fields_unknown(const Victim& target) {
  send_unknown_fields(target, "");
}
void send_unknown_fields_known(const Victim& target) {
  send_unknown_fields(target, "Bearer " + token_of(target.kind));
}

void reset_calls(const Victim& target) {
  Http2Client client(target.address);
  while (client.alive() && !over) {
    for (int i = 0; i < 64; ++i) client.reset(client.open("/weft.v1.MeshService/GetServerInfo"));
    if (!client.flush()) break;
    client.listen(milliseconds(0));
  }
}

// Bodies that never end.
void begin_messages(const Victim& target, const Http2Client::Headers& headers) {
  std::vector<std::unique_ptr<Http2Client>> clients;
  std::vector<std::uint32_t> streams;
  for (int i = 0; i < 8; ++i) {
    auto& client = clients.emplace_back(std::make_unique<Http2Client>(target.address));
    streams.push_back(client->open("/weft.v1.MeshService/GenerateMesh", headers));
    client->send(streams.back(), message_prefix(47 * kMiB));
  }
  const std::string junk(64 << 10, '\x0a');
  const auto end = steady_clock::now() + seconds(5);
  while (steady_clock::now() < end && !over)
    for (std::size_t i = 0; i < clients.size(); ++i) {
      if (!clients[i]->alive() || clients[i]->ended(streams[i])) continue;
      clients[i]->send(streams[i], junk);
      clients[i]->listen(milliseconds(5));
    }
}
void begin_messages_unknown(const Victim& target) {
  begin_messages(target, {});
}
void begin_messages_known(const Victim& target) {
  begin_messages(target, {{"authorization", "Bearer " + token_of(target.kind)}});
}

// Calls of this mesh, so many at a time, read to their end.
void ask_together(const Victim& target, const v1::GenerateMeshRequest& request, int calls) {
  std::vector<std::thread> threads;
  for (int i = 0; i < calls; ++i)
    threads.emplace_back([&] {
      grpc::ClientContext context;
      identify(context, target.kind);
      const auto reader =
          v1::MeshService::NewStub(connect(target.address))->GenerateMesh(&context, request);
      v1::GenerateMeshResponse message;
      while (reader->Read(&message)) continue;
      (void)reader->Finish();
    });
  for (std::thread& thread : threads) thread.join();
}
// 170 M triangles, of which neither the size nor a picture of it tells.
void ask_for_crumbs(const Victim& target) {
  v1::GenerateMeshRequest request = square("1");
  v1::Region& region = *request.mutable_domain()->add_regions();
  region.set_x(0.5);
  region.set_y(0.5);
  region.set_max_area(1e-8);
  ask_together(target, request, 6);
}
void ask_for_a_spike(const Victim& target) {
  ask_together(target, square("hypot(x-0.5,y-0.5)<0.0065?4e-12:0.01"), 6);
}
void flood(const Victim& target) {
  ask_together(target, square("1e-5"), 90);
}

void read_nothing(const Victim& target) {
  const v1::GenerateMeshRequest request = square("1e-6");
  std::vector<std::unique_ptr<grpc::ClientContext>> contexts;
  std::vector<std::unique_ptr<grpc::ClientReader<v1::GenerateMeshResponse>>> readers;
  for (int i = 0; i < 10; ++i) {
    identify(*contexts.emplace_back(std::make_unique<grpc::ClientContext>()), target.kind);
    readers.push_back(v1::MeshService::NewStub(connect(target.address))
                          ->GenerateMesh(contexts.back().get(), request));
  }
  for (int i = 0; i < 80 && !over; ++i) std::this_thread::sleep_for(milliseconds(100));
  for (std::size_t i = 0; i < readers.size(); ++i) {
    contexts[i]->TryCancel();
    (void)readers[i]->Finish();
  }
}

void submit_and_cancel(const Victim& target) {
  const auto stub = v1::JobService::NewStub(connect(target.address));
  for (int i = 0; i < 200 && !over; ++i) {
    v1::SubmitJobRequest submission;
    *submission.mutable_mesh() = square("1e-6*(1+" + std::to_string(i) + "*x)");
    v1::SubmitJobResponse submitted;
    grpc::ClientContext submitting;
    identify(submitting, target.kind);
    if (!stub->SubmitJob(&submitting, submission, &submitted).ok()) continue;
    v1::CancelJobRequest cancel;
    cancel.set_id(submitted.job().id());
    v1::CancelJobResponse cancelled;
    grpc::ClientContext cancelling;
    identify(cancelling, target.kind);
    (void)stub->CancelJob(&cancelling, cancel, &cancelled);
  }
}

void send_long_ids(const Victim& target) {
  const auto channel = connect(target.address);
  for (const char* method : {"/weft.v1.JobService/GetJob", "/weft.v1.JobService/DeleteJob"})
    for (const std::size_t bytes : {std::size_t{60'000}, std::size_t{8} << 20})
      (void)raw_unary(channel, method, repeated("A", bytes), "Bearer " + token_of(target.kind));
}

using Act = void (*)(const Victim& target);
// Of kHostileKinds.
constexpr Act kActs[] = {send_unknown_fields_unknown,
                         send_unknown_fields_known,
                         reset_calls,
                         begin_messages_unknown,
                         begin_messages_known,
                         ask_for_crumbs,
                         ask_for_a_spike,
                         flood,
                         read_nothing,
                         submit_and_cancel,
                         send_long_ids};
static_assert(std::size(kActs) == std::size(kHostileKinds));

// Returns how often it did so.
int act(std::size_t kind, const std::string& address) {
  int rounds = 0;
  for (; !over; ++rounds) {
    try {
      kActs[kind]({address, kHostileKinds[kind]});
    } catch (const std::exception&) {
      // The server refused the connection.
    }
  }
  return rounds;
}

}  // namespace
}  // namespace weft::e2e

int main(int argc, char** argv) {
  using namespace weft::e2e;
  if (argc < 3) return 2;
  (void)setpriority(PRIO_PROCESS, 0, 19);
  const std::string address = argv[1];
  const bool encrypted = argc > 3 && std::string(argv[3]) == "tls";
  const std::vector<std::string> only(argv + std::min(argc, 4), argv + argc);
  std::vector<std::thread> threads;
  for (const Flood& flood : kFloods)
    if (std::find(only.begin(), only.end(), flood.name) != only.end())
      threads.emplace_back([&flood, &address, encrypted] {
        const Flooded flooded = flood.run({address, encrypted}, [] { return over.load(); });
        std::printf("%s: %llu connections, %llu closed\n", flood.name,
                    static_cast<unsigned long long>(flooded.connections),
                    static_cast<unsigned long long>(flooded.closed));
      });
  for (std::size_t kind = 0; kind < std::size(kHostileKinds); ++kind)
    if (only.empty() || std::find(only.begin(), only.end(), kHostileKinds[kind]) != only.end())
      threads.emplace_back([kind, &address] {
        const int rounds = act(kind, address);
        std::printf("%s: %d rounds\n", kHostileKinds[kind], rounds);
      });
  std::this_thread::sleep_for(std::chrono::duration<double>(std::atof(argv[2])));
  over = true;
  for (std::thread& thread : threads) thread.join();
}

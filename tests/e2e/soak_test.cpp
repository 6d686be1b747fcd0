// SPDX-License-Identifier: Apache-2.0
// What a server holds on to: nothing of jobs that are over, and little of clients that read slowly.
#include <grpcpp/client_context.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "client/call/mesh_call.h"
#include "files/formats/domain_formats.h"
#include "tests/e2e/fleet.h"
#include "tests/e2e/programs.h"

namespace weft::e2e {
namespace {

using std::chrono::milliseconds;

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;

// The pipe at its coarsest, and no two the same.
v1::GenerateMeshRequest small_request(int number) {
  static const auto domain = files::read_domain(model("pipe.poly")).value();
  client::RequestOptions request_options;
  request_options.size = std::to_string(500 + number);
  return client::make_request(domain, request_options);
}

void submit(v1::JobService::Stub& stub, const v1::GenerateMeshRequest& mesh) {
  v1::SubmitJobRequest request;
  *request.mutable_mesh() = mesh;
  v1::SubmitJobResponse response;
  grpc::Status status;
  do {
    grpc::ClientContext context;
    status = stub.SubmitJob(&context, request, &response);
  } while (is_full(status));
  EXPECT_TRUE(status.ok()) << status.error_message();
}

// Every second one as a job that nobody waits for, the others by GenerateMesh; on a few connections
// at once.
void make_small_meshes(const Server& server, int first, int end) {
  constexpr int kConnections = 8;
  std::atomic<int> next{first};
  std::vector<std::thread> clients;
  for (int c = 0; c < kConnections; ++c)
    clients.emplace_back([&] {
      const auto channel = connect(server.address());
      const auto jobs = v1::JobService::NewStub(channel);
      const auto meshes = v1::MeshService::NewStub(channel);
      for (int number = next++; number < end; number = next++) {
        if (number % 2 == 0) {
          submit(*jobs, small_request(number));
        } else {
          grpc::ClientContext context;
          v1::GenerateMeshResponse message;
          const auto reader = meshes->GenerateMesh(&context, small_request(number));
          EXPECT_NE(digest_of_stream(*reader, message), "");
          EXPECT_TRUE(reader->Finish().ok());
        }
      }
    });
  for (std::thread& client : clients) client.join();
  EXPECT_TRUE(server.shows("weft_queue_length{queue=\"jobs\"}", 0));
  EXPECT_TRUE(server.shows("weft_running_jobs{queue=\"jobs\"}", 0));
}

TEST(Soak, MemoryAndDescriptorsDoNotGrowWithTheNumberOfJobs) {
  const Folder folder;
  const Server server(
      {"--data", folder / "data", "--metrics", "127.0.0.1:0", "--cache-bytes", "1MiB"});
  // What is allocated once, and what is kept of finished meshes, is there after the first mark.
  const std::vector<int> marks = {few_or_many(100, 1000), few_or_many(300, 5000),
                                  few_or_many(600, 10000)};
  std::vector<std::uint64_t> bytes;
  std::vector<std::size_t> files;
  int made = 0;
  for (const int mark : marks) {
    make_small_meshes(server, made, mark);
    made = mark;
    bytes.push_back(server.resident_bytes());
    files.push_back(server.open_files());
    std::printf("after %d meshes: %.1f MiB, %zu descriptors\n", mark,
                static_cast<double>(bytes.back()) / kMiB, files.back());
  }
  EXPECT_EQ(server.metric("weft_jobs_total{state=\"succeeded\"}"), marks.back() / 2);
  if (kMemoryTells) {
    EXPECT_LT(bytes.back(), bytes.front() + 16 * kMiB);
  }
  EXPECT_LE(files.back(), files.front() + 8);
}

// Reads the resident memory again and again, and keeps the most.
class PeakMemory {
 public:
  explicit PeakMemory(const Server& server)
      : thread_([this, &server] {
          while (!stop_) {
            peak_ = std::max(peak_.load(), server.resident_bytes());
            std::this_thread::sleep_for(milliseconds(2));
          }
        }) {}
  ~PeakMemory() {
    stop_ = true;
    thread_.join();
  }
  std::uint64_t bytes() const { return peak_; }

 private:
  std::atomic<bool> stop_{false};
  std::atomic<std::uint64_t> peak_{0};
  std::thread thread_;
};

// Until it takes no more memory.
void let_settle(const Server& server) {
  std::uint64_t before = 0;
  std::uint64_t now = server.resident_bytes();
  do {
    before = now;
    std::this_thread::sleep_for(milliseconds(200));
    now = server.resident_bytes();
  } while (now > before);
}

// A client of its own connection that reads when it is told to.
template <class Message>
struct SlowReader {
  grpc::ClientContext context;
  std::unique_ptr<grpc::ClientReader<Message>> reader;
  std::string digests;  // of the chunks
  std::string digest;   // of the mesh, as its summary says

  // False at the end.
  bool read() {
    Message message;
    if (!reader->Read(&message)) return false;
    if (message.has_chunk()) digests += message.chunk().sha256();
    if (message.has_summary()) digest = message.summary().sha256();
    return true;
  }
};

// One message after the other.
template <class Message>
void read_slowly(std::vector<SlowReader<Message>>& readers, milliseconds pause) {
  for (std::size_t reading = readers.size(); reading > 0;) {
    std::this_thread::sleep_for(pause);
    for (SlowReader<Message>& slow : readers) {
      if (slow.reader == nullptr || slow.read()) continue;
      EXPECT_TRUE(slow.reader->Finish().ok());
      slow.reader.reset();
      --reading;
    }
  }
  for (const SlowReader<Message>& slow : readers) EXPECT_EQ(sha256(slow.digests), slow.digest);
}

// Returns how much the memory has grown at most, and prints it.
std::uint64_t growth(std::uint64_t before, const PeakMemory& peak, int readers,
                     std::uint64_t mesh_bytes) {
  std::printf("%d readers of %.1f MiB each: %.1f MiB before, %.1f MiB at most\n", readers,
              static_cast<double>(mesh_bytes) / kMiB, static_cast<double>(before) / kMiB,
              static_cast<double>(peak.bytes()) / kMiB);
  return peak.bytes() - std::min(before, peak.bytes());
}

TEST(Soak, SlowReadersHoldLittleOfTheirMeshesInTheServersMemory) {
  constexpr int kReaders = 50;
  const Folder folder;
  const Server server({"--data", folder / "data"});
  const auto stub = v1::JobService::NewStub(connect(server.address()));
  v1::SubmitJobRequest submission;
  const auto domain = files::read_domain(model("cylinder.poly")).value();
  const std::string size = "0.003 / " + std::to_string(few_or_many(1, 5));
  *submission.mutable_mesh() = client::make_request(domain, {.size = size});
  v1::SubmitJobResponse submitted;
  grpc::ClientContext submitting;
  ASSERT_TRUE(stub->SubmitJob(&submitting, submission, &submitted).ok());
  ASSERT_TRUE(wait_for_job(*stub, submitted.job().id()));
  v1::FetchMeshRequest fetch;
  fetch.set_id(submitted.job().id());

  std::uint64_t mesh_bytes = 0;
  {
    grpc::ClientContext context;
    const auto reader = stub->FetchMesh(&context, fetch);
    v1::FetchMeshResponse message;
    while (reader->Read(&message)) mesh_bytes += message.ByteSizeLong();
    ASSERT_TRUE(reader->Finish().ok());
  }
  const std::uint64_t before = server.resident_bytes();
  const PeakMemory peak(server);
  std::vector<SlowReader<v1::FetchMeshResponse>> readers(kReaders);
  for (auto& slow : readers)
    slow.reader =
        v1::JobService::NewStub(connect(server.address()))->FetchMesh(&slow.context, fetch);
  let_settle(server);  // nobody reads yet: it has all the time to read ahead
  read_slowly(readers, milliseconds(few_or_many(2, 100)));
  const std::uint64_t grown = growth(before, peak, kReaders, mesh_bytes);
  if (!kMemoryTells) return;
  EXPECT_LT(grown, kReaders * mesh_bytes / 2);
  EXPECT_LT(grown, kReaders * 6 * kMiB);
}

v1::GenerateMeshRequest cylinder_of(const std::string& size) {
  static const auto domain = files::read_domain(model("cylinder.poly")).value();
  return client::make_request(domain, {.size = size});
}

// The engine holds the mesh that it makes, whoever reads it; no more of it waits to be read than
// with FetchMesh.
TEST(Soak, SlowReadersOfMeshesInTheMakingHoldLittleBesidesTheEngineAndHoldNobodyBack) {
  // While it reads nothing, a client of gRPC looks at one connection every 5 s: of 50, most would
  // not answer the server's pings in time.
  const int kReaders = few_or_many(5, 12);
  const Server server({"--threads", "2", "--jobs", std::to_string(kReaders + 1), "--memory", "1TiB",
                       "--stall-timeout", "3600", "--cache-bytes", "0", "--metrics",
                       "127.0.0.1:0"});
  const auto stub = v1::MeshService::NewStub(connect(server.address()));
  const v1::GenerateMeshRequest large = cylinder_of("5e-4");
  std::uint64_t mesh_bytes = 0;
  std::uint64_t engine_bytes = 0;
  // On its own connection, to its end.
  const auto read_large = [&] {
    grpc::ClientContext context;
    const auto reader = stub->GenerateMesh(&context, large);
    v1::GenerateMeshResponse message;
    for (mesh_bytes = 0; reader->Read(&message);) mesh_bytes += message.ByteSizeLong();
    engine_bytes = message.summary().peak_engine_bytes();
    return reader->Finish().ok();
  };
  ASSERT_TRUE(read_large());
  const std::uint64_t before = server.resident_bytes();
  const PeakMemory peak(server);
  std::vector<SlowReader<v1::GenerateMeshResponse>> readers(static_cast<std::size_t>(kReaders));
  for (auto& slow : readers)
    slow.reader =
        v1::MeshService::NewStub(connect(server.address()))->GenerateMesh(&slow.context, large);
  EXPECT_TRUE(server.shows("weft_pausing_jobs{queue=\"calls\"}", kReaders));
  let_settle(server);
  const std::uint64_t grown = growth(before, peak, kReaders, mesh_bytes);
  EXPECT_TRUE(read_large());
  EXPECT_TRUE(server.shows("weft_pausing_jobs{queue=\"calls\"}", kReaders));
  read_slowly(readers, milliseconds(few_or_many(2, 100)));
  if (kMemoryTells) {
    EXPECT_LT(grown, static_cast<std::uint64_t>(kReaders) * (engine_bytes + mesh_bytes / 2));
  }
}

}  // namespace
}  // namespace weft::e2e

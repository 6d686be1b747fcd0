// SPDX-License-Identifier: Apache-2.0
#include "server/observe/metrics.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <ctime>
#include <thread>
#include <vector>

#include "tests/server/logged_server.h"
#include "tests/server/raw_call.h"
#include "tests/support/http.h"

namespace weft::server::testing {
namespace {

using weft::testing::http;
using weft::testing::value_of;

TEST(Metrics, CountCallsByMethodAndCode) {
  Metrics metrics("v", "e");
  metrics.call_ended("GenerateMesh", grpc::StatusCode::OK, 0.2);
  metrics.call_ended("GenerateMesh", grpc::StatusCode::OK, 0.3);
  metrics.call_ended("GenerateMesh", grpc::StatusCode::RESOURCE_EXHAUSTED, 0);
  metrics.call_ended("GetServerInfo", grpc::StatusCode::OK, 0);
  const std::string text = metrics.text();
  const auto count = [&](const std::string& code, const std::string& method) {
    return value_of(text, "weft_requests_total{code=\"" + code + "\",method=\"" + method + "\"}");
  };
  EXPECT_EQ(count("OK", "GenerateMesh"), 2) << text;
  EXPECT_EQ(count("RESOURCE_EXHAUSTED", "GenerateMesh"), 1);
  EXPECT_EQ(count("OK", "GetServerInfo"), 1);
}

TEST(Metrics, PutSecondsIntoBuckets) {
  Metrics metrics("v", "e");
  metrics.call_ended("GenerateMesh", grpc::StatusCode::OK, 0.2);
  metrics.waited(0.2);
  metrics.refined(0.2);
  metrics.first_chunk(0.2);
  const std::string text = metrics.text();
  for (const std::string name :
       {"weft_queue_seconds", "weft_refine_seconds", "weft_first_chunk_seconds"}) {
    EXPECT_EQ(value_of(text, name + "_bucket{le=\"0.1\"}"), 0) << name;
    EXPECT_EQ(value_of(text, name + "_bucket{le=\"0.25\"}"), 1) << name;
    EXPECT_EQ(value_of(text, name + "_count"), 1) << name;
    EXPECT_EQ(value_of(text, name + "_sum"), 0.2) << name;
  }
  const std::string request = "weft_request_seconds_bucket{method=\"GenerateMesh\",le=";
  EXPECT_EQ(value_of(text, request + "\"0.1\"}"), 0) << text;
  EXPECT_EQ(value_of(text, request + "\"0.25\"}"), 1);
}

TEST(Metrics, AddUpWhatStreamsCarry) {
  Metrics metrics("v", "e");
  metrics.chunk_sent(1000);
  metrics.chunk_sent(500);
  EXPECT_EQ(value_of(metrics.text(), "weft_streamed_bytes_total"), 1500);
  metrics.triangles_made(20);
  metrics.triangles_made(10);
  EXPECT_EQ(value_of(metrics.text(), "weft_triangles_total"), 30);
}

TEST(Metrics, CountWhatBecomesOfJobsFromZeroOn) {
  Metrics metrics("v", "e");
  for (const std::string state : {"queued", "running", "succeeded", "failed", "cancelled"}) {
    const std::string series = "weft_jobs_total{state=\"" + state + "\"}";
    EXPECT_EQ(value_of(metrics.text(), series), 0) << state;
    metrics.job_became(state);
    EXPECT_EQ(value_of(metrics.text(), series), 1) << state;
  }
}

TEST(Metrics, CountCallbacksByOutcomeFromZeroOn) {
  Metrics metrics("v", "e");
  for (const std::string outcome : {"delivered", "put_off", "failed"}) {
    const std::string series = "weft_callbacks_total{outcome=\"" + outcome + "\"}";
    EXPECT_EQ(value_of(metrics.text(), series), 0) << outcome;
    metrics.callback_sent(outcome);
    EXPECT_EQ(value_of(metrics.text(), series), 1) << outcome;
  }
}

TEST(Metrics, CountClosedConnectionsByCauseFromZeroOn) {
  Metrics metrics("v", "e");
  const std::string series = "weft_connections_closed_total{cause=\"resets\"}";
  EXPECT_EQ(value_of(metrics.text(), series), 0);
  metrics.connection_closed("resets");
  EXPECT_EQ(value_of(metrics.text(), series), 1);
  metrics.set_connections([] { return 7.0; });
  EXPECT_EQ(value_of(metrics.text(), "weft_connections"), 7);
}

TEST(Metrics, CountHitsMissesLostLeasesAndDamagedChunksFromZeroOn) {
  Metrics metrics("v", "e");
  const auto values = [&] {
    const std::string text = metrics.text();
    return std::vector<double>{
        value_of(text, "weft_cache_hits_total"), value_of(text, "weft_cache_misses_total"),
        value_of(text, "weft_leases_lost_total"), value_of(text, "weft_damaged_chunks_total")};
  };
  EXPECT_EQ(values(), (std::vector<double>{0, 0, 0, 0}));
  metrics.cache_hit();
  metrics.cache_missed();
  metrics.cache_missed();
  metrics.leases_lost(3);
  for (int i = 0; i < 4; ++i) metrics.chunk_damaged();
  EXPECT_EQ(values(), (std::vector<double>{1, 2, 3, 4}));
}

TEST(Metrics, AskQueuesWhenTheyAreScraped) {
  Metrics metrics("v", "e");
  double waiting = 3;
  metrics.add_queue("calls", [&] {
    return QueueStats{.waiting = waiting, .running = 2, .pausing = 7, .admitted_bytes = 4096};
  });
  metrics.add_queue("jobs", [] { return QueueStats{}; });
  EXPECT_EQ(value_of(metrics.text(), "weft_queue_length{queue=\"calls\"}"), 3);
  waiting = 5;
  const std::string text = metrics.text();
  EXPECT_EQ(value_of(text, "weft_queue_length{queue=\"calls\"}"), 5);
  EXPECT_EQ(value_of(text, "weft_running_jobs{queue=\"calls\"}"), 2);
  EXPECT_EQ(value_of(text, "weft_pausing_jobs{queue=\"calls\"}"), 7);
  EXPECT_EQ(value_of(text, "weft_admission_bytes{queue=\"calls\"}"), 4096);
  EXPECT_EQ(value_of(text, "weft_queue_length{queue=\"jobs\"}"), 0);
}

TEST(Metrics, TellVersions) {
  const std::string text = Metrics("0.1.0", "2").text();
  EXPECT_EQ(value_of(text, "weft_build_info{engine=\"2\",version=\"0.1.0\"}"), 1) << text;
}

TEST(Metrics, TellWhatTheProcessTakes) {
  constexpr std::size_t kBytes = std::size_t{64} << 20;
  void* const memory = ::mmap(nullptr, kBytes, PROT_READ | PROT_WRITE,
                              MAP_PRIVATE | MAP_ANONYMOUS | MAP_POPULATE, -1, 0);
  const std::string text = Metrics("v", "e").text();
  ::munmap(memory, kBytes);
  EXPECT_GT(value_of(text, "process_resident_memory_bytes"), kBytes);
  EXPECT_GT(value_of(text, "process_virtual_memory_bytes"), kBytes);
  EXPECT_GE(value_of(text, "process_cpu_seconds_total"), 0);
  EXPECT_GE(value_of(text, "process_threads"), 1);
  EXPECT_GT(value_of(text, "process_max_fds"), 3);
  const double now = static_cast<double>(std::time(nullptr));
  EXPECT_NEAR(value_of(text, "process_start_time_seconds"), now, 3600);
  // Threads of earlier tests may still close a few.
  std::vector<int> files(50);
  for (int& file : files) file = ::dup(STDOUT_FILENO);
  EXPECT_GT(value_of(Metrics("v", "e").text(), "process_open_fds"),
            value_of(text, "process_open_fds") + 40);
  for (const int file : files) ::close(file);
}

TEST(Metrics, LoseNothingToThreadsThatCountAtOnce) {
  Metrics metrics("v", "e");
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      for (int i = 0; i < 1000; ++i) {
        metrics.call_ended("GenerateMesh", grpc::StatusCode::OK, 0);
        metrics.triangles_made(1);
        if (i % 100 == 0) metrics.text();
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(value_of(metrics.text(), "weft_triangles_total"), 4000);
  EXPECT_EQ(value_of(metrics.text(), "weft_requests_total{code=\"OK\",method=\"GenerateMesh\"}"),
            4000);
}

TEST(MetricsOfAServer, TellOfItsCalls) {
  Event begun;
  Event release;
  const EngineFn engine = [&](const auto&, ChunkSink& sink, auto&) {
    begun.set();
    EXPECT_TRUE(release.wait());
    Chunk chunk = make_chunk(0);
    chunk.triangles = {0, 1, 2, 0, 2, 3};
    EXPECT_TRUE(sink.accept(std::move(chunk)));
    Summary summary;
    summary.chunks = 1;
    summary.engine_seconds = 0.2;
    return Result<Summary>(summary);
  };
  auto server = Server::start({.listen = {"127.0.0.1:0"}, .service = {}, .metrics = "127.0.0.1:0"},
                              engine, make_logger("off"))
                    .value();
  const auto scrape = [&] { return http(server->metrics_address(), "GET", "/metrics"); };
  const auto channel = channel_to(server->addresses().front(), grpc::InsecureChannelCredentials());
  const auto stub = v1::MeshService::NewStub(channel);
  grpc::ClientContext context;
  const auto reader = stub->GenerateMesh(&context, valid_request());
  ASSERT_TRUE(begun.wait());
  EXPECT_EQ(value_of(scrape(), "weft_running_jobs{queue=\"calls\"}"), 1);
  release.set();
  EXPECT_TRUE(read_all(*reader).status.ok());
  EXPECT_TRUE(ask(channel).ok());
  EXPECT_EQ(raw_generate_mesh(channel, "").error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  // The last figures may come after the answer.
  EXPECT_TRUE(
      eventually([&] { return value_of(scrape(), "weft_running_jobs{queue=\"calls\"}") == 0; }));

  const std::string text = scrape();
  const auto calls = [&](const char* method, const char* code) {
    return value_of(text,
                    fmt::format("weft_requests_total{{code=\"{}\",method=\"{}\"}}", code, method));
  };
  EXPECT_EQ(calls("GenerateMesh", "OK"), 1) << text;
  EXPECT_EQ(calls("GenerateMesh", "INVALID_ARGUMENT"), 1);
  EXPECT_EQ(calls("GetServerInfo", "OK"), 1);
  EXPECT_EQ(value_of(text, "weft_triangles_total"), 2);
  EXPECT_GT(value_of(text, "weft_streamed_bytes_total"), 64);
  EXPECT_EQ(value_of(text, "weft_first_chunk_seconds_count"), 1);
  EXPECT_EQ(value_of(text, "weft_queue_seconds_count"), 1);
  EXPECT_EQ(value_of(text, "weft_refine_seconds_sum"), 0.2);
}

}  // namespace
}  // namespace weft::server::testing

// SPDX-License-Identifier: Apache-2.0
// Everything that ends a job before its time.
#include <grpcpp/create_channel_posix.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <thread>

#include "tests/server/harness.h"
#include "tests/server/logged_server.h"

namespace weft::server::testing {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// An engine that works until it is stopped, and keeps what it was told.
struct StoppableEngine {
  Event started;
  Event stopped;
  std::optional<Error> why;

  EngineFn function() {
    return [this](const MeshRequest&, ChunkSink&, weft::Run& run) {
      started.set();
      Result<Summary> result = work_until_stopped(run);
      why = result.error();
      stopped.set();
      return result;
    };
  }
};

TEST(Stop, ACancelledCallStopsTheEngine) {
  StoppableEngine engine;
  TestServer server(engine.function());
  grpc::ClientContext context;
  auto reader = server.stub()->GenerateMesh(&context, valid_request());
  ASSERT_TRUE(engine.started.wait());
  context.TryCancel();
  ASSERT_TRUE(engine.stopped.wait());
  EXPECT_EQ(engine.why->code, ErrorCode::kCancelled);
  EXPECT_EQ(read_all(*reader).status.error_code(), grpc::StatusCode::CANCELLED);
}

TEST(Stop, ACallsDeadlineStopsTheEngine) {
  StoppableEngine engine;
  TestServer server(engine.function());
  // A deadline may pass before the engine has begun: the next one leaves it twice as long.
  for (milliseconds time(50); !engine.started.happened() && time < seconds(100); time *= 2) {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + time);
    auto reader = server.stub()->GenerateMesh(&context, valid_request());
    EXPECT_EQ(read_all(*reader).status.error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
  }
  EXPECT_TRUE(engine.stopped.wait());
}

TEST(Stop, TheBudgetOfSecondsStopsTheEngine) {
  StoppableEngine engine;
  TestServer server(engine.function());
  v1::GenerateMeshRequest request = valid_request();
  request.mutable_budget()->set_max_seconds(0.05);
  const Outcome outcome = call(*server.stub(), request);
  EXPECT_EQ(outcome.status.error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
  EXPECT_NE(outcome.status.error_message().find("0.05 s"), std::string::npos);
  EXPECT_EQ(details_of(outcome.status).error_info.reason(), "DEADLINE_EXCEEDED");
  EXPECT_TRUE(engine.stopped.wait());
}

TEST(Stop, TheBudgetOfSecondsEndsAJobThatWaitsForItsReader) {
  std::atomic<std::uint32_t> sent{0};
  Event refused;
  ServiceOptions options;
  options.tick = milliseconds(5);
  TestServer server(
      [&](const auto&, ChunkSink& sink, auto&) {
        auto result = send_until_refused(sink, sent);
        refused.set();
        return result;
      },
      options);
  v1::GenerateMeshRequest request = valid_request();
  request.mutable_budget()->set_max_seconds(0.2);
  auto stub = server.stub();
  grpc::ClientContext context;
  auto reader = stub->GenerateMesh(&context, request);
  EXPECT_TRUE(refused.wait());
  EXPECT_EQ(read_all(*reader).status.error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
}

TEST(Stop, ASlowReaderHoldsUpItsOwnJobOnlyAndMemoryStaysBounded) {
  std::atomic<std::uint32_t> sent{0};
  Event refused;
  std::atomic<bool> first{true};
  ServiceOptions options;
  options.jobs = 2;
  TestServer server(
      [&](const auto&, ChunkSink& sink, auto&) {
        if (!first.exchange(false)) return send_chunks(sink, 50, kMaxChunkBytes);
        auto result = send_until_refused(sink, sent);
        refused.set();
        return result;
      },
      options);
  auto slow_stub = server.stub();
  grpc::ClientContext slow_context;
  auto slow = slow_stub->GenerateMesh(&slow_context, valid_request());
  v1::GenerateMeshResponse message;
  do ASSERT_TRUE(slow->Read(&message));
  while (!message.has_chunk());
  for (int i = 0; i < 3; ++i) {
    const Outcome other = call(*server.stub(), valid_request());
    EXPECT_TRUE(other.status.ok()) << other.status.error_message();
    EXPECT_EQ(other.chunk_indices().size(), 50u);
  }
  EXPECT_LT(sent, 40u) << "150 MiB went to the others meanwhile";
  slow_context.TryCancel();
  EXPECT_TRUE(refused.wait());
}

// More clients than there are slots, none of which reads: another one's call does not wait for
// them.
TEST(Stop, ClientsThatReadNothingKeepNoOtherFromASlot) {
  constexpr int kStalled = 6;
  std::atomic<int> streams{0};
  std::atomic<std::uint32_t> sent{0};
  ServiceOptions options;
  options.jobs = 2;
  options.light_jobs = 1;
  options.queue = 10;
  options.limits.stream_buffer = std::uint64_t{1} << 20;
  TestServer server(
      [&](const auto&, ChunkSink& sink, auto&) {
        if (streams++ < kStalled) return send_until_refused(sink, sent);
        return send_chunks(sink, 20, kMaxChunkBytes);
      },
      options);
  struct Stalled {
    std::unique_ptr<v1::MeshService::Stub> stub;
    grpc::ClientContext context;
    std::unique_ptr<grpc::ClientReader<v1::GenerateMeshResponse>> reader;
  };
  std::vector<Stalled> stalled(kStalled);
  for (Stalled& client : stalled) {
    client.stub = server.stub();
    client.reader = client.stub->GenerateMesh(&client.context, valid_request());
  }
  EXPECT_TRUE(eventually([&] { return streams == kStalled; }));
  const Outcome other = call(*server.stub(), valid_request());
  EXPECT_TRUE(other.status.ok()) << other.status.error_message();
  EXPECT_EQ(other.chunk_indices().size(), 20u);
  for (Stalled& client : stalled) {
    client.context.TryCancel();
    EXPECT_EQ(read_all(*client.reader).status.error_code(), grpc::StatusCode::CANCELLED);
  }
}

TEST(Stop, AClientThatReadsNothingIsCutOff) {
  std::atomic<std::uint32_t> sent{0};
  Event refused;
  ServiceOptions options;
  options.tick = milliseconds(10);
  options.patience.stall_timeout = milliseconds(200);
  TestServer server(
      [&](const auto&, ChunkSink& sink, auto&) {
        auto result = send_until_refused(sink, sent);
        refused.set();
        return result;
      },
      options);
  auto stub = server.stub();
  grpc::ClientContext context;
  auto reader = stub->GenerateMesh(&context, valid_request());
  EXPECT_TRUE(refused.wait());
  EXPECT_EQ(read_all(*reader).status.error_code(), grpc::StatusCode::CANCELLED);
}

TEST(Stop, AClientThatReadsNothingOfAFinishedMeshIsCutOff) {
  Event finished;
  ServiceOptions options;
  options.tick = milliseconds(10);
  options.patience.stall_timeout = milliseconds(200);
  TestServer server(
      [&](const auto&, ChunkSink& sink, auto&) {
        auto result = send_chunks(sink, 8, kMaxChunkBytes);  // the hand-over takes them all
        finished.set();
        return result;
      },
      options);
  auto stub = server.stub();
  grpc::ClientContext context;
  auto reader = stub->GenerateMesh(&context, valid_request());
  ASSERT_TRUE(finished.wait());
  server->drain(std::chrono::seconds(30));  // returns as soon as no call is open
  EXPECT_FALSE(read_all(*reader).status.ok());
}

// A client that pauses before each chunk of 1 MiB, of a mesh of 64: how its call ends.
grpc::Status read_slowly(milliseconds pause, std::uint64_t least_rate) {
  ServiceOptions options;
  options.tick = milliseconds(10);
  options.patience = {.stall_timeout = 25 * pause, .least_rate = least_rate};
  TestServer server(
      [&](const auto&, ChunkSink& sink, auto&) { return send_chunks(sink, 64, kMaxChunkBytes); },
      options);
  auto stub = server.stub();
  grpc::ClientContext context;
  auto reader = stub->GenerateMesh(&context, valid_request());
  v1::GenerateMeshResponse message;
  while (reader->Read(&message)) std::this_thread::sleep_for(pause);
  return reader->Finish();
}

TEST(Stop, AClientThatReadsBelowTheLeastRateIsCutOff) {
  EXPECT_EQ(read_slowly(milliseconds(40), 1'000'000'000).error_code(), grpc::StatusCode::CANCELLED);
  // A machine that stands still looks like a client that reads nothing: it is given more time then.
  grpc::Status patient(grpc::StatusCode::UNKNOWN, "");
  for (milliseconds pause(40); !patient.ok() && pause < seconds(2); pause *= 2)
    patient = read_slowly(pause, 0);
  EXPECT_TRUE(patient.ok()) << patient.error_message();
}

// A connection that the test can cut under gRPC's feet.
class CutConnection {
 public:
  explicit CutConnection(const std::string& address)
      : fd_(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port =
        htons(static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1))));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    ::connect(fd_, reinterpret_cast<const sockaddr*>(&to), sizeof(to));
    channel_ = grpc::CreateInsecureChannelFromFd("cut", ::dup(fd_));
  }
  ~CutConnection() { ::close(fd_); }
  std::shared_ptr<grpc::Channel> channel() const { return channel_; }
  void cut() { ::shutdown(fd_, SHUT_RDWR); }

 private:
  int fd_;
  std::shared_ptr<grpc::Channel> channel_;
};

TEST(Stop, AVanishedClientStopsTheEngine) {
  StoppableEngine engine;
  TestServer server(engine.function());
  CutConnection connection(server.address());
  auto stub = v1::MeshService::NewStub(connection.channel());
  grpc::ClientContext context;
  auto reader = stub->GenerateMesh(&context, valid_request());
  ASSERT_TRUE(engine.started.wait());
  connection.cut();
  ASSERT_TRUE(engine.stopped.wait());
  EXPECT_EQ(engine.why->code, ErrorCode::kCancelled);
  EXPECT_EQ(read_all(*reader).status.error_code(), grpc::StatusCode::UNAVAILABLE);
}

TEST(Stop, AClientThatVanishesWhileTheEngineWaitsForRoomStopsIt) {
  std::atomic<std::uint32_t> sent{0};
  Event refused;
  TestServer server([&](const auto&, ChunkSink& sink, auto&) {
    auto result = send_until_refused(sink, sent);
    refused.set();
    return result;
  });
  CutConnection connection(server.address());
  auto stub = v1::MeshService::NewStub(connection.channel());
  grpc::ClientContext context;
  auto reader = stub->GenerateMesh(&context, valid_request());
  v1::GenerateMeshResponse message;
  do ASSERT_TRUE(reader->Read(&message));
  while (!message.has_chunk());
  connection.cut();
  EXPECT_TRUE(refused.wait());
  EXPECT_FALSE(read_all(*reader).status.ok());
}

TEST(Stop, DrainingRefusesNewCallsAndLetsOpenOnesFinish) {
  Event release;
  Event started;
  TestServer server([&](const auto&, ChunkSink& sink, auto&) {
    started.set();
    EXPECT_TRUE(release.wait());
    return send_chunks(sink, 20);
  });
  auto stub = server.stub();
  grpc::ClientContext context;
  auto reader = stub->GenerateMesh(&context, valid_request());
  ASSERT_TRUE(started.wait());
  std::thread drainer([&] { server->drain(std::chrono::seconds(30)); });
  grpc::Status info;
  do {
    grpc::ClientContext info_context;
    v1::GetServerInfoResponse response;
    info = stub->GetServerInfo(&info_context, {}, &response);
  } while (info.ok());  // until the gate is closed
  EXPECT_EQ(info.error_code(), grpc::StatusCode::UNAVAILABLE);
  const Outcome refused = call(*stub, valid_request());
  EXPECT_EQ(refused.status.error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(details_of(refused.status).error_info.reason(), "STOPPING");
  EXPECT_TRUE(details_of(refused.status).retry_info);
  release.set();
  const Outcome open = read_all(*reader);
  EXPECT_TRUE(open.status.ok()) << open.status.error_message();
  EXPECT_EQ(open.chunk_indices().size(), 20u);
  drainer.join();
}

TEST(Stop, DrainingEndsWhatDoesNotFinishInTime) {
  StoppableEngine engine;
  TestServer server(engine.function());
  auto stub = server.stub();
  grpc::ClientContext context;
  auto reader = stub->GenerateMesh(&context, valid_request());
  grpc::ClientContext waiting_context;
  auto waiting = stub->GenerateMesh(&waiting_context, valid_request());
  ASSERT_TRUE(engine.started.wait());
  server->drain(milliseconds(10));
  EXPECT_TRUE(engine.stopped.wait());
  const Outcome outcome = read_all(*reader);
  EXPECT_EQ(outcome.status.error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(details_of(outcome.status).error_info.reason(), "STOPPING");
  EXPECT_EQ(read_all(*waiting).status.error_code(), grpc::StatusCode::UNAVAILABLE);
}

TEST(Stop, DrainingEndsThoughAClientReadsNothing) {
  std::atomic<std::uint32_t> sent{0};
  Event refused;
  TestServer server([&](const auto&, ChunkSink& sink, auto&) {
    auto result = send_until_refused(sink, sent);
    refused.set();
    return result;
  });
  auto stub = server.stub();
  grpc::ClientContext context;
  auto reader = stub->GenerateMesh(&context, valid_request());
  v1::GenerateMeshResponse message;
  do ASSERT_TRUE(reader->Read(&message));
  while (!message.has_chunk());
  server->drain(milliseconds(10));
  EXPECT_TRUE(refused.wait());
  EXPECT_FALSE(read_all(*reader).status.ok());
}

}  // namespace
}  // namespace weft::server::testing
